#!/usr/bin/env bash
# Makes every picture of the book again, by the commands of its pages:
#
#   docs/pictures/make.sh [PROGRAM]        the program is target/release/noslip unless another is given
#
# A picture belongs to the command on the page that shows it. Of the gallery the commands are read from the pages; of the
# others they stand here, and a test compares the names.
set -euo pipefail
pictures=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$pictures/../.." && pwd)
noslip=$(realpath "${1:-$root/target/release/noslip}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# take FOLDER/MADE.svg NAME.svg
take() {
    cp "$1" "$pictures/$2"
    echo "$2"
}

for page in "$root"/docs/gallery/*.md; do
    scene=$(basename "$page" .md)
    command=$(sed -n "s/^noslip \(compare $scene .*\) --report DIR$/\1/p" "$page")
    if [ -n "$command" ]; then
        # shellcheck disable=SC2086
        "$noslip" $command --report "$scene" >/dev/null
        take "$scene/$scene-path.svg" "$scene-path.svg"
    fi
done
take turnaround/turnaround-constraint.svg turnaround-constraint.svg

"$noslip" compare turnaround --methods dla,dla4,dla8,rk4,rk4-projected --report pages >/dev/null
for look in light=1 dark=0; do
    chromium --headless=new --no-sandbox --hide-scrollbars --window-size=1500,1790 --force-device-scale-factor=0.75 \
        --blink-settings=preferredColorScheme="${look#*=}" --screenshot="report-${look%=*}.png" "file://$work/pages/index.html" 2>/dev/null
done
take report-light.png report-light.png
take report-dark.png report-dark.png

example() {
    cargo run --quiet --manifest-path "$root/Cargo.toml" --example "$1" -- "$work/$2" >/dev/null
}
example naive_methods naive
take naive/naive-constraint.svg naive-constraint.svg
take naive/naive-energy.svg naive-energy.svg
example circles circles
take circles/circles-path.svg circles-path.svg
