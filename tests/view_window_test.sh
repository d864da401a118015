#!/usr/bin/env bash
# The viewer in a real window: a display of its own (Xvfb), the software driver, real input events
# (xdotool), pictures of the window taken and compared.
#   tests/view_window_test.sh PROGRAM
# Exits with 77 (skipped) where Xvfb or xdotool is missing.
set -euo pipefail
program=$(realpath "$1")

for tool in Xvfb xvfb-run xdotool; do
  if ! command -v "$tool" >/dev/null; then
    echo "skipped: $tool is missing (Debian: apt-get install xvfb xdotool)"
    exit 77
  fi
done
if [ -z "${VERDURE_VIEW_DISPLAY:-}" ]; then
  VERDURE_VIEW_DISPLAY=1 exec xvfb-run -a -s "-screen 0 1024x768x24" "$0" "$program"
fi

# The software driver, whatever else there is.
for icd in /usr/share/vulkan/icd.d/lvp_icd*.json; do
  [ -e "$icd" ] && export VK_ICD_FILENAMES="$icd" VK_DRIVER_FILES="$icd"
done
folder=$(mktemp -d)
viewer=
cleanup() {
  [ -n "$viewer" ] && kill "$viewer" 2>/dev/null || true
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
  for _ in $(seq $((seconds * 10))); do
    "$@" && return
    kill -0 "$viewer" 2>/dev/null || fail "the viewer ended while it was waited for: $what"
    sleep 0.1
  done
  fail "no $what after $seconds s"
}
find_window() { window=$(xdotool search --onlyvisible --pid "$viewer" 2>/dev/null | tail -n 1) && [ -n "$window" ]; }
title() { xdotool getwindowname "$window" 2>/dev/null; }
is_idle() { [[ $(title) == *"- verdure" ]]; }
is_busy() { [[ $(title) == *"- verdure ("* ]]; }
is_there() { [ -s "$1" ]; }
ended() { ! kill -0 "$viewer" 2>/dev/null; }

# The picture without panels, as NAME.png, once it has come to rest.
picture() {
  sleep 1
  rm -f verdure-*.png
  xdotool key F12
  wait_for 20 "picture $1" is_there verdure-0001.png
  mv verdure-0001.png "$1.png"
  [ -n "${VERDURE_VIEW_KEEP:-}" ] && cp "$1.png" "$VERDURE_VIEW_KEEP/" || true
}
differs() {
  cmp -s "$1.png" "$2.png" && fail "$3: the picture is as before"
  return 0
}
same() { cmp -s "$1.png" "$2.png" || fail "$3: the picture is another"; }
# With the mouse button $1 from $2 $3 to $4 $5, slowly enough for a software driver's frames.
drag() {
  xdotool mousemove --window "$window" "$2" "$3"
  sleep 0.2
  xdotool mousedown "$1"
  for i in 1 2 3 4 5; do
    sleep 0.15
    xdotool mousemove --window "$window" $(($2 + ($4 - $2) * i / 5)) $(($3 + ($5 - $3) * i / 5))
  done
  sleep 0.2
  xdotool mouseup "$1"
}

start() {
  "$program" view "$@" --validation 2>errors.txt &
  viewer=$!
  wait_for 30 "window" find_window
  xdotool windowfocus "$window"
}
# Ends it; 0 is expected, and silence of the validation layer.
close_and_check() {
  for _ in 1 2; do
    ended || xdotool key ctrl+q 2>/dev/null || true
    sleep 0.3
  done
  for _ in $(seq 300); do
    ended && break
    sleep 0.1
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
grep -q "verdure render" errors.txt || fail "no display: it does not point to render"
[ "$(wc -l <errors.txt)" -eq 1 ] || fail "no display: more than one line"

# A file that is none.
code=0
"$program" view missing.glb 2>errors.txt || code=$?
[ "$code" -eq 2 ] || fail "a missing file: it ended with $code"

"$program" grow --species quaking-aspen --set Leaves=6 --texture-size 64 --leaves card -o plant.glb >/dev/null

# Look around.
start plant.glb --size 700x520
wait_for 60 "loaded plant" is_idle
picture first
picture first-again
same first first-again "nothing was done"
drag 1 500 250 600 230
picture orbit
differs first orbit "a drag"
drag 3 500 250 560 250
picture around
differs orbit around "a right drag"
xdotool mousemove --window "$window" 500 250
xdotool click 4
xdotool click 4
picture zoom
differs around zoom "the wheel"
xdotool keydown w
sleep 0.5
xdotool keyup w
picture flown
differs zoom flown "W"
xdotool key Home
picture home
same first home "Home"

# The window with its panels, without them, in another size, out of sight and back, without focus.
xdotool key shift+F12
wait_for 20 "picture of the window" is_there verdure-window.png
xdotool key Tab
picture alone
differs home alone "Tab"
xdotool windowsize --sync "$window" 500 400
picture small
xdotool windowsize --sync "$window" 801 603
picture large
xdotool windowunmap --sync "$window"
sleep 0.5
xdotool windowmap --sync "$window"
sleep 1
xdotool windowfocus "$window"
picture mapped
same large mapped "out of sight and back"
xdotool key Tab
xdotool windowsize --sync "$window" 700 520
picture back
same first back "all as at first"
other=$(xdotool search --maxdepth 0 --name '' 2>/dev/null | head -n 1)
[ -n "$other" ] && xdotool windowfocus "$other" 2>/dev/null || true
sleep 0.3
xdotool windowfocus "$window"
picture focused
same back focused "focus lost and found"

# A bake starts by a key and ends; the wind blows.
xdotool key b
sleep 0.3
wait_for 60 "end of the bake" is_idle
xdotool key space
sleep 1
xdotool key space
picture wind
differs focused wind "wind"
close_and_check "closed"

# Closed while it bakes.
start plant.glb --size 400x300
wait_for 30 "work in the background" is_busy
close_and_check "closed while it loads"

echo "the viewer's window: ok"
