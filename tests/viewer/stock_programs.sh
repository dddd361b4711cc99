#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Usage: ONLY=osgshadow stock_programs.sh FILE.glb...
# Runs OSG's example programs (Debian: openscenegraph) under Xvfb over each character as it is, over its first frame
# stored as plain geometry (STILL_MESH makes it), and over the character held at that frame. Prints a line each: whether
# the program ended well, the number of different pictures of some ten (plain geometry's behind it: the program itself
# may move things), the pixels in which the held character differs from the plain geometry and those that differ much
# ("-" where pictures change), and messages that the plain geometry does not cause. Exit status 0: all as with plain
# geometry, and animated; 77: a program is not there. ONLY: a pattern of program lines. KEEP: a folder for pictures.
set -euo pipefail
width=1280 height=1024 # Some programs place their windows themselves.
source "$(dirname "${BASH_SOURCE[0]}")/screen.sh"

programs=(osgpick osgcompositeviewer osgprerender osgoutline osgscribe osgthirdpersonview osgreflect osgcallback
    osgkeyboardmouse osgsimplifier osgdistortion osgcopy osglight osgmultiviewpaging)
# OSG 3.6's osgshadow refuses --sv ("ShadowVolume no longer supported"), which --two-sided and --two-pass belong to.
for technique in --sm --ssm --pssm "--msm --positionalLight" --lispsm --stsm --vdsm --st; do
    programs+=("osgshadow --noUpdate $technique" "osgshadow --noUpdate --base $technique")
done
mapfile -t models < <(realpath "$@")
cd "$folder" # osgcopy writes files.
# The fixed pipeline lights the vertices of plain geometry, the character's program lights each fragment: smooth meshes
# differ by up to 29 of 255. Edges round differently: at most 6 pixels.
tolerance=32 mostPixels=10
# Without lights the fixed pipeline draws white lines, the character's program the material's diffuse colour. It has no
# soft shadows: SoftShadowMap's edges are hard. osgthirdpersonview draws the frustum, whose planes follow the bounds, and a
# character's hold its whole clip. ViewDependentShadowMap's program leaves the light's ambient part out of the shadow.
differs='^osgscribe|^osgthirdpersonview|--ssm|--vdsm'
export OSG_RUN_FRAME_COUNT=75 OSG_RUN_MAX_FRAME_RATE=30 OSG_WINDOW="0 0 256 256"

# over NAME FILE PROGRAM...: $status is its exit status ("own loop": it had to be ended), $pictures the number of
# different pictures; $folder/NAME.log what it said, $folder/NAME.picture the last one that was seen.
over()
{
    local name=$1 file=$2 tenths program
    shift 2
    "$@" "$file" >"$folder/out" 2>"$folder/$name.log" &
    program=$!
    cp "$empty" "$folder/$name.picture"
    for ((tenths = 0; tenths < 600; ++tenths)); do
        if ! kill -0 $program 2>/dev/null || ! cmp -s "$screen" "$empty"; then break; fi
        sleep 0.1
    done
    sleep 0.5 # The first frame may be half way onto the screen.
    : >"$folder/sums"
    for ((tenths = 0; tenths < 8; ++tenths)); do
        kill -0 $program 2>/dev/null || break
        cp "$screen" "$folder/now"
        kill -0 $program 2>/dev/null || break
        cmp -s "$folder/now" "$empty" || { mv "$folder/now" "$folder/$name.picture"; md5sum <"$folder/$name.picture" >>"$folder/sums"; }
        sleep 0.2
    done
    pictures=$(sort -u "$folder/sums" | wc -l)
    for ((tenths = 0; tenths < 30; ++tenths)); do
        kill -0 $program 2>/dev/null || break
        sleep 0.1
    done
    if kill -KILL $program 2>/dev/null; then
        wait $program 2>/dev/null || true
        status="own loop"
    else
        status=0
        wait $program 2>/dev/null || status=$?
    fi
    for ((tenths = 0; tenths < 50; ++tenths)); do
        cmp -s "$screen" "$empty" && break
        sleep 0.1
    done
}

# differing A B: the pixels that differ, and those of them that differ by more than $tolerance of 255.
differing()
{
    { cmp -l <(pixels "$1") <(pixels "$2") || true; } | awk -v tolerance=$tolerance '
        function level(octal) { return 64 * int(octal / 100) + 8 * int(octal % 100 / 10) + octal % 10 }
        {
            pixel = int(($1 - 1) / 4)
            difference = level($2) - level($3)
            any[pixel]
            if (difference > tolerance || difference < -tolerance) much[pixel]
        }
        END { print length(any) "/" length(much) }'
}

failures=0
printf '%-44s %-10s %-9s %-9s %-7s %s\n' program model ended pictures differ messages
for model in "${models[@]}"; do
    name=$(basename "$model" .glb)
    "$STILL_MESH" "$model" "$folder/still.osgt" >/dev/null
    # The look of the fixed pipeline, which plain geometry is drawn by.
    osgconv -O "start=0 speed=0 lighting=fixed" "$model" "$folder/held.osgb" >"$folder/osgconv.log" 2>&1
    osgconv -O "lighting=fixed" "$model" "$folder/moving.osgb" >>"$folder/osgconv.log" 2>&1
    for line in "${programs[@]}"; do
        [[ $line =~ ${ONLY:-.} ]] || continue
        read -ra program <<<"$line"
        command -v "${program[0]}" >/dev/null || { echo "there is no ${program[0]}"; exit 77; }
        over still "$folder/still.osgt" "${program[@]}"
        stillStatus=$status stillPictures=$pictures
        heldPictures=0 heldStatus=$status
        if [ "$stillPictures" -eq 1 ]; then
            over held "$folder/held.osgb" "${program[@]}"
            heldPictures=$pictures heldStatus=$status
        fi
        over moving "$folder/moving.osgb" "${program[@]}"
        differ=-
        [ "$stillPictures" -ne 1 ] || [ "$heldPictures" -ne 1 ] || differ=$(differing "$folder/still.picture" "$folder/held.picture")
        messages=$(comm -13 <(sort -u "$folder/still.log") <(sort -u "$folder/moving.log") | head -3 | tr '\n' ';')
        [[ $differ == - || $line =~ $differs || ${differ#*/} -le $mostPixels ]] || messages+="other pixels;"
        verdict=
        [ "$status" = "$stillStatus" ] && [ "$heldStatus" = "$stillStatus" ] && [ "$pictures" -gt 1 ] && [ -z "$messages" ] ||
            { verdict=" FAILED"; failures=$((failures + 1)); }
        printf '%-44s %-10s %-9s %-9s %-7s %s\n' "$line" "$name" "$status" "$pictures/$stillPictures" "$differ" "$messages$verdict"
        if [ -n "${KEEP:-}" ]; then
            for picture in still held moving; do
                [ -f "$folder/$picture.picture" ] || continue
                cp "$folder/$picture.picture" "$KEEP/$name.${line// /}.$picture.xwd"
                cp "$folder/$picture.log" "$KEEP/$name.${line// /}.$picture.log"
            done
        fi
    done
done
echo "$failures failed"
[ $failures -eq 0 ]
