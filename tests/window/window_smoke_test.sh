#!/usr/bin/env bash
# Starts the real program on a virtual X server, uses mouse and keyboard, and closes it.
#   window_smoke_test.sh PROGRAM
# Exit status 77: skipped, because a tool is missing.
set -euo pipefail

program=$1
for tool in Xvfb xdotool; do
  if ! command -v "$tool" >/dev/null; then
    echo "skipped: $tool is not installed"
    exit 77
  fi
done

folder=$(mktemp -d)
server="" application=""
clean_up() {
  if [[ -n $application ]]; then kill "$application" 2>/dev/null || true; fi
  if [[ -n $server ]]; then kill "$server" 2>/dev/null || true; fi
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap clean_up EXIT

fail() {
  echo "FAILED: $*"
  sed 's/^/  program: /' "$folder/output" 2>/dev/null || true
  exit 1
}
alive() { kill -0 "$application" 2>/dev/null || fail "the program ended after: $1"; }

# wait_for SECONDS COMMAND...
wait_for() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    ((SECONDS < end)) || return 1
    sleep 0.1
  done
}

cd "$folder"
export HOME=$folder XDG_CONFIG_HOME=$folder/config
remembered=$XDG_CONFIG_HOME/bvhscope/workspace.json

# Without a display: one sentence and exit status 1.
status=0
env -u DISPLAY -u WAYLAND_DISPLAY "$program" 2>output >/dev/null || status=$?
((status == 1)) || fail "without a display the exit status is $status, not 1"
(($(wc -l <output) == 1)) || fail "without a display it does not say one sentence"

Xvfb -displayfd 3 -screen 0 1280x800x24 -noreset -nolisten tcp 3>display 2>server.log &
server=$!
wait_for 30 test -s display || fail "Xvfb does not start: $(cat server.log)"
DISPLAY=:$(cat display)
export DISPLAY
unset WAYLAND_DISPLAY

"$program" teapots >output 2>&1 &
application=$!
wait_for 60 xdotool search --onlyvisible --name '^bvhscope' || fail "no window appears"
window=$(xdotool search --onlyvisible --name '^bvhscope' | head -1)
xdotool windowfocus "$window" || true
sleep 2

xdotool mousemove 600 300 mousedown 1 mousemove_relative 60 20 sleep 0.2 mouseup 1
alive "a drag in the picture"
xdotool mousemove 600 300 click 1 sleep 0.2 click 4 sleep 0.2 click 5 sleep 0.2 click 3
alive "clicks and the wheel in the picture"
xdotool key Escape
for key in F1 Escape 2 3 m m c r f o o space space ctrl+z ctrl+y; do
  xdotool key "$key"
  sleep 0.1
  alive "the key $key"
done
for x in 40 120 1100 1240; do
  for y in 10 60 200 500 700; do
    xdotool mousemove "$x" "$y" click 1
    sleep 0.05
  done
  xdotool key Escape
done
alive "clicks all over the window"
xdotool windowsize "$window" 700 500 sleep 0.5 windowsize "$window" 1280 800 sleep 0.5
alive "two changes of the window's size"

xdotool key Escape key Escape key F12
wait_for 30 sh -c "ls '$folder'/bvhscope-*.png" || fail "F12 saves no picture"

xdotool key ctrl+q
wait_for 30 sh -c "! kill -0 $application" || fail "Ctrl+Q does not close the window"
status=0
wait "$application" || status=$?
application=
((status == 0)) || fail "the exit status is $status"
[[ ! -s output ]] || fail "the program printed something"
[[ -s $remembered ]] || fail "the layout was not remembered"

# Rubbish in the remembered layout costs a notice, and the old file is kept.
echo '{"layout":' >"$remembered"
"$program" teapots --frames 20 --timings >output 2>&1 || fail "the second start fails"
grep -q 'p95' output || fail "--timings prints no frame times"
[[ -s $remembered.bad-1 ]] || fail "the rubbish was not kept as workspace.json.bad-1"
cat output
