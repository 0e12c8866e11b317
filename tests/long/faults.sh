#!/usr/bin/env bash
# The counts of docs/reliability.md: each fault so many times, 100 unless a number is given. Runs that are killed at random moments, signals that
# come together, files that are damaged, disks that are full. What is not as it should be fails a test; the others print how many there were.
set -euo pipefail
cd "$(dirname "$0")/../.."
export NOSLIP_TRIES=${1:-100}
tests() { cargo test --workspace --test tests -- --nocapture --test-threads 1 "$@"; }
tests --ignored cli::rows::ended cli::rows::a_damaged cli::ensemble::killed cli::ensemble::a_damaged cli::parts::a_damaged cli::parts::a_part \
    cli::signals::two_signals
tests cli::streams::a_full_disk cli::streams::a_file_beyond cli::ensemble::what_was_ended cli::files
