# SPDX-License-Identifier: MIT
# For `source`: a screen of $width x $height pixels (256 x 256 unless set before) under Xvfb, whose picture lies in a
# file, $screen; $empty is what it is at first. Offers show PICTURE ARGUMENT... and pixels PICTURE; ends with 77 where a
# program is not there. $folder is for files of one's own.
for program in Xvfb osgviewer osgconv; do
    command -v $program >/dev/null || { echo "there is no $program"; exit 77; }
done

width=${width:-256} height=${height:-256}
folder=$(mktemp -d)
server=
end()
{
    [ -z "$server" ] || kill "$server" 2>/dev/null || true
    wait || true
    rm -rf "$folder"
}
trap end EXIT

# The first display number that is free, told on file descriptor 3.
Xvfb -displayfd 3 -screen 0 ${width}x${height}x24 -nocursor -noreset -nolisten tcp -fbdir "$folder" 3>"$folder/number" 2>"$folder/xvfb.log" &
server=$!
for ((tenths = 0; tenths < 300; ++tenths)); do
    [ ! -s "$folder/number" ] || break
    sleep 0.1
done
[ -s "$folder/number" ] || { cat "$folder/xvfb.log"; exit 1; }
export DISPLAY=:$(cat "$folder/number")
screen=$folder/Xvfb_screen0
empty=$folder/empty
cp "$screen" "$empty"

# show PICTURE ARGUMENT...: osgviewer with the arguments, until it has shown the same picture for a second.
show()
{
    local picture=$1 quiet=0 viewer
    shift
    osgviewer --window 0 0 256 256 "$@" >"$folder/log" 2>&1 &
    viewer=$!
    cp "$empty" "$picture"
    for ((tenths = 0; tenths < 600 && quiet < 10; ++tenths)); do
        sleep 0.1
        kill -0 $viewer || { cat "$folder/log"; return 1; }
        if cmp -s "$screen" "$picture" && ! cmp -s "$screen" "$empty"; then
            quiet=$((quiet + 1))
        else
            quiet=0
            cp "$screen" "$picture"
        fi
    done
    kill -KILL $viewer
    wait $viewer 2>/dev/null || true
    [ $quiet -eq 10 ] || { echo "osgviewer $*: no picture, or one that does not keep still"; cat "$folder/log"; return 1; }
}

# pixels PICTURE: four bytes each, row by row, without what comes before them in an XWD file.
pixels()
{
    tail -c $((width * height * 4)) "$1"
}
