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
for picture in naive-balanced-constraint.svg naive-balanced-energy.svg naive-unbalanced-energy.svg; do
    take "naive/$picture" "$picture"
done
example circles circles
take circles/circles-path.svg circles-path.svg
take circles/circles-curvature.svg circles-curvature.svg
example parking parking.svg
take parking.svg parking-gap.svg

# Of the worked examples.
for example in "backing dla,dla4 path worked-backing.svg" "rattle gauss8,dla path worked-rattle.svg" \
    "slipping rk4,rk4-projected,dla,dla4 constraint worked-slipping.svg"; do
    read -r scene methods kind picture <<<"$example"
    "$noslip" compare "$root/docs/worked/$scene.toml" --methods "$methods" --report "worked-$scene" >/dev/null
    take "worked-$scene/$scene-$kind.svg" "$picture"
done

"$noslip" plot "$root/docs/worked/gait.toml" --columns path,theta,speed --size 15x12cm --out gait.svg >/dev/null
take gait.svg worked-gait.svg

"$noslip" equilibria turnaround --picture portrait.svg >/dev/null
take portrait.svg straight-portrait.svg
"$noslip" equilibria thrust-well --picture thrust.svg >/dev/null
take thrust.svg exchange-thrust.svg
"$noslip" phase planimeter --loops 40 --picture phase.svg >/dev/null
take phase.svg phase-map.svg

# The scenes of the hard cases begin with their commands: stability-small-spin.svg from docs/stability/small-spin.toml.
for file in "$root"/docs/stability/*.toml; do
    case=$(basename "$file" .toml)
    command=$(sed -n "s|^# noslip \(compare\) docs/stability/$case.toml \(.*\) --report DIR$|\1 $file \2|p" "$file")
    # shellcheck disable=SC2086
    "$noslip" $command --report "stability-$case" >/dev/null
    case $case in
        attractor | steep-hill) kind=energy ;;
        round-off) kind=constraint ;;
        *) kind=path ;;
    esac
    take "stability-$case/$case-$kind.svg" "stability-$case.svg"
done

# The hard cases that no scene shows.
cargo run --quiet --manifest-path "$root/Cargo.toml" --example hard_cases -- hard-cases "$noslip" >/dev/null
for picture in hard-cases/*.svg; do
    take "$picture" "$(basename "$picture")"
done

# Minutes from here on.
chaos=$root/docs/chaos
"$noslip" lyapunov "$chaos/valley.toml" --duration 20000 --out exponents.svg >/dev/null
take exponents.svg chaos-valley-exponents.svg
"$noslip" section "$chaos/well.toml" --energy 0.2 --plane along=0 --axes across,turn_rate --starts 24 --duration 1000 --out well.svg >/dev/null
take well.svg chaos-well.svg
"$noslip" section "$chaos/valley.toml" --plane center_y=0 --starts 4 --duration 6000 --out valley.svg >/dev/null
take valley.svg chaos-valley.svg
"$noslip" section egg-crate-attractor --step 0.1 --plane turn_rate=0 --starts 4 --duration 8000 --out egg-crate.svg >/dev/null
take egg-crate.svg chaos-egg-crate.svg
"$noslip" lyapunov "$chaos/well.toml" --map speed=-1.2:1.2:30 --map turn_rate=-1.1:1.1:24 --duration 200 --out map.svg >/dev/null
take map.svg chaos-map.svg
