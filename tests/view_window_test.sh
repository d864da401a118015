#!/usr/bin/env bash
# The viewer in a real window: a display of its own (Xvfb), the software driver, real input events
# (xdotool; drop_files.cpp), pictures of the window taken and compared.
#   tests/view_window_test.sh PROGRAM DROP_FILES
# Exits with 77 (skipped) where Xvfb, xdotool or 9wm is missing, or the program has no viewer.
set -euo pipefail
program=$(realpath "$1")
drop_files=$(realpath "$2")

for tool in Xvfb xvfb-run xdotool 9wm; do
  if ! command -v "$tool" >/dev/null; then
    echo "skipped: $tool is missing (Debian: apt-get install xvfb xdotool 9wm)"
    exit 77
  fi
done
if [ -z "${VERDURE_VIEW_DISPLAY:-}" ]; then
  VERDURE_VIEW_DISPLAY=1 exec xvfb-run -a -s "-screen 0 1024x768x24" "$0" "$program" "$drop_files"
fi

# The software driver, whatever else there is.
for icd in /usr/share/vulkan/icd.d/lvp_icd*.json; do
  [ -e "$icd" ] && export VK_ICD_FILENAMES="$icd" VK_DRIVER_FILES="$icd"
done
folder=$(mktemp -d)
viewer=
manager=
cleanup() {
  [ -n "$viewer" ] && kill "$viewer" 2>/dev/null || true
  [ -n "$manager" ] && kill -KILL "$manager" 2>/dev/null || true
  rm -rf "$folder"
}
trap cleanup EXIT
cd "$folder"

fail() {
  echo "FAILED: $1" >&2
  cat errors.txt >&2 || true
  exit 1
}

# Waits until a command succeeds, at most so many seconds.
wait_for() {
  local seconds=$1 what=$2
  shift 2
  for _ in $(seq $((seconds * 20))); do
    "$@" && return
    kill -0 "$viewer" 2>/dev/null || fail "the viewer ended while it was waited for: $what"
    sleep 0.05
  done
  fail "no $what after $seconds s"
}
find_window() { window=$(xdotool search --onlyvisible --pid "$viewer" 2>/dev/null | tail -n 1) && [ -n "$window" ]; }
title() { xdotool getwindowname "$window" 2>/dev/null; }
is_idle() { [[ $(title) == *"- verdure" ]]; }
is_busy() { [[ $(title) == *"- verdure ("* ]]; }
is_titled() { [ "$(title)" = "$1" ]; }
is_minimised() { [ -z "$(xdotool search --onlyvisible --pid "$viewer" 2>/dev/null)" ]; }
is_there() { [ -s "$1" ]; }
ended() { ! kill -0 "$viewer" 2>/dev/null; }

keep() { [ -z "${VERDURE_VIEW_KEEP:-}" ] || cp "$1.png" "$VERDURE_VIEW_KEEP/"; }
# The window with its panels, as window-NAME.png, by the frame that has all input so far.
window_picture() {
  rm -f verdure-window.png
  xdotool key shift+F12
  wait_for 20 "picture of the window: $1" is_there verdure-window.png
  mv verdure-window.png "window-$1.png"
  keep "window-$1"
}
# The picture without panels. A frame takes it before its input moves the camera: hence the window's.
picture() {
  window_picture "$1"
  rm -f verdure-0001.png
  xdotool key F12
  wait_for 20 "picture $1" is_there verdure-0001.png
  mv verdure-0001.png "$1.png"
  keep "$1"
}
differs() {
  cmp -s "$1.png" "$2.png" && fail "$3: the picture is as before"
  return 0
}
same() { cmp -s "$1.png" "$2.png" || fail "$3: the picture is another"; }
# With the mouse button $1 from $2 $3 to $4 $5.
drag() {
  xdotool mousemove --window "$window" "$2" "$3" sleep 0.05 mousedown "$1"
  for i in 1 2 3; do
    xdotool sleep 0.05 \
      mousemove --window "$window" $(($2 + ($4 - $2) * i / 3)) $(($3 + ($5 - $3) * i / 3))
  done
  xdotool sleep 0.05 mouseup "$1"
}

drop() {
  "$drop_files" "$window" "$1" || fail "$1: not taken"
  sleep 0.1
}

start() {
  "$program" view "$@" --validation 2>errors.txt &
  viewer=$!
  wait_for 30 "window" find_window
  xdotool windowfocus "$window"
}
# Ends it; 0 is expected, and silence of the validation layer.
close_and_check() {
  xdotool key ctrl+q
  for _ in $(seq 600); do
    ended && break
    sleep 0.05
  done
  ended || fail "$1: it does not close"
  local code=0
  wait "$viewer" || code=$?
  viewer=
  [ "$code" -eq 0 ] || fail "$1: it ended with $code"
  if grep -q "Vulkan validation" errors.txt; then fail "$1: the validation layer complains"; fi
}

# Without a display it says so and where to go.
code=0
env -u DISPLAY -u WAYLAND_DISPLAY "$program" view 2>errors.txt || code=$?
[ "$code" -eq 2 ] || fail "no display: it ended with $code"
if grep -q "this build has no viewer" errors.txt; then
  echo "skipped: this build has no viewer"
  exit 77
fi
grep -q "verdure render" errors.txt || fail "no display: it does not point to render"
[ "$(wc -l <errors.txt)" -eq 1 ] || fail "no display: more than one line"

# A file that is none.
code=0
"$program" view missing.glb 2>errors.txt || code=$?
[ "$code" -eq 2 ] || fail "a missing file: it ended with $code"

"$program" grow --species quaking-aspen --set Levels=2 --set Leaves=20 --texture-size 64 --leaves card \
  -o plant.glb >/dev/null

# Look around.
start plant.glb --size 560x420
wait_for 60 "loaded plant" is_idle
picture first
picture first-again
same first first-again "nothing was done"
read -r -a size <<<"$(od -An -tu1 -j16 -N8 first.png)"
"$program" render plant.glb -o rendered.png \
  --size $((size[2] * 256 + size[3]))x$((size[6] * 256 + size[7])) >/dev/null
same rendered first "what render writes"
drag 1 440 200 540 180
picture orbit
differs first orbit "a drag"
drag 3 440 200 500 200
picture around
differs orbit around "a right drag"
xdotool mousemove --window "$window" 440 200
xdotool click 4
xdotool click 4
picture zoom
differs around zoom "the wheel"
xdotool keydown w
picture flown
xdotool keyup w
differs zoom flown "W"
xdotool key Home
picture home
same first home "Home"

# The window with its panels, without them, in another size, out of sight and back, without focus.
xdotool key Tab
picture alone
differs home alone "Tab"
xdotool windowsize --sync "$window" 420 340
picture small
xdotool windowsize --sync "$window" 641 483
picture large
xdotool windowunmap --sync "$window"
sleep 0.2
xdotool windowmap --sync "$window"
xdotool windowfocus "$window"
picture mapped
same large mapped "out of sight and back"
# A window manager minimises it, by a client's wish.
9wm 2>/dev/null &
manager=$!
sleep 0.2
xdotool windowminimize "$window"
wait_for 10 "icon" is_minimised
sleep 0.2  # some frames of nothing
xdotool windowmap --sync "$window"
kill -KILL "$manager"  # it waits for an event before it ends
wait "$manager" 2>/dev/null || true
manager=
xdotool windowfocus "$window"
picture restored
same large restored "minimised and back"
xdotool key Tab
xdotool windowsize --sync "$window" 560 420
picture back
same first back "all as at first"
other=$(xdotool search --maxdepth 0 --name '' 2>/dev/null | head -n 1)
[ -n "$other" ] && xdotool windowfocus "$other" 2>/dev/null || true
sleep 0.1
xdotool windowfocus "$window"
picture focused
same back focused "focus lost and found"

# A bake starts by a key and ends; the wind blows. That is undone and done again.
xdotool key b
sleep 0.3
wait_for 60 "end of the bake" is_idle
picture baked
same focused baked "the same bake again"
wait_for 5 "unchanged scene" is_titled "plant.glb - verdure"
xdotool key space
sleep 0.3
xdotool key space
picture wind
differs baked wind "wind"
wait_for 5 "changed scene" is_titled "plant.glb * - verdure"
xdotool key ctrl+z
picture undone
same baked undone "undo"
wait_for 5 "scene without changes" is_titled "plant.glb - verdure"
xdotool key ctrl+shift+z
wait_for 5 "redone change" is_titled "plant.glb * - verdure"
picture redone
differs undone redone "redo"

# Changes are not lost unasked: whatever would discard them, cancelled, does nothing.
cp plant.glb "second plant.glb"
still_there() {
  window_picture "$1"
  is_titled "plant.glb * - verdure" || fail "$1: the scene is gone: $(title)"
  xdotool key Escape
  window_picture "$1-cancelled"
}
drop "second plant.glb"
still_there dropped
xdotool key ctrl+g
window_picture grow
xdotool key Return
still_there grown
xdotool key ctrl+o
window_picture open
xdotool type "second plant.glb"
xdotool key Return
still_there opened
xdotool keydown ctrl keydown q keyup ctrl  # Q alone would fly
still_there closed
xdotool keyup q
picture kept
same redone kept "what was cancelled"
# Discarded, then saved, by a dialog for its name.
drop "second plant.glb"
xdotool mousemove --window "$window" 280 230 sleep 0.1 click 1  # Discard
wait_for 30 "dropped plant" is_titled "second plant.glb - verdure"
"$program" render plant.glb -o sky.exr --size 16x8 >/dev/null
drop sky.exr  # a setting, which asks nothing
wait_for 5 "changed scene" is_titled "second plant.glb * - verdure"
drop plant.glb
xdotool key Return  # Save
window_picture save-as
xdotool key Return  # as scene.json
wait_for 30 "plant dropped after saving" is_titled "plant.glb - verdure"
for name in "second plant.glb" sky.exr; do
  grep -q "\"$name\"" scene.json || fail "the scene that was to be saved has no $name"
done
# Asked to close a second time, it closes.
xdotool key space
window_picture changed
xdotool key ctrl+q
window_picture asked
close_and_check "closed"

# Closed while it loads.
echo '{"format": "verdure-scene", "version": 1, "plants": [{"grow": {"species": "black-oak"}}]}' >oak.json
start oak.json --size 400x300
wait_for 30 "work in the background" is_busy
close_and_check "closed while it loads"

echo "the viewer's window: ok"
