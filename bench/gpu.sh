#!/usr/bin/env bash
# Builds, checks and times everything that runs on OpenGL, on whatever renderer this machine has; no network is needed.
#
#   bench/gpu.sh [DEVICE]      as --gl-device; the figures go to standard output and bench-gpu/figures.txt
#
# Ten minutes at most: what does not fit is left out, and said.
set -euo pipefail
cd "$(dirname "$0")/.."
device=${1:-} out=bench-gpu
began=$(date +%s)
mkdir -p "$out"

say() { printf '\n== %s\n' "$*"; }
left() { echo $((570 - $(date +%s) + began)); }

say "building"
cmake -S . -B "$out/build" -DCMAKE_BUILD_TYPE=Release -DEVENMESH_GL=ON -DEVENMESH_BENCH=ON -DEVENMESH_TESTS=ON \
  -Wno-dev --log-level=WARNING >/dev/null
cmake --build "$out/build" --target evenmesh bench_glsl test_gl -j "$(nproc)" >"$out/build.log" 2>&1 ||
  { tail -20 "$out/build.log"; exit 1; }
program=$out/build/evenmesh

{
  say "the machine"
  "$program" --version -v
  grep -m1 'model name' /proc/cpuinfo || true
  nproc | sed 's/$/ processors/'

  say "tests of the room gl"
  timeout "$(left)" "$out/build/test_gl" --gtest_brief=1 2>&1 | tail -5

  say "sampling at resolution 512, all of the grid, and with a Lipschitz bound of 1"
  for shader in "mandelbulb rounds=7 skin=0" gyroid blobs; do
    for bound in 0 1; do
      [ "$(left)" -lt 30 ] && { echo "left out: $shader $bound, no time"; continue; }
      read -r name definitions <<<"$shader"
      # shellcheck disable=SC2086
      timeout "$(left)" "$out/build/bench_glsl" "examples/glsl/$name.glsl" 512 $bound "$device" $definitions | tail -2
    done
  done

  say "the examples, 5,000 and 50,000 vertices"
  printf '%-12s %9s %9s %7s %6s %10s %9s\n' shader vertices Q-mean Q-least Euler sampling_s total_s
  for vertices in 5000 50000; do
    for shader in examples/glsl/*.glsl; do
      name=$(basename "$shader" .glsl)
      [ "$(left)" -lt 20 ] && { echo "left out: $name $vertices, no time"; continue; }
      status=0 start=$(date +%s.%N)
      timeout "$(left)" "$program" mesh "$shader" -n "$vertices" ${device:+--gl-device "$device"} -o "$out/$name.ply" \
        --json "$out/$name.json" -q || status=$?
      figure() { sed -n "s/^ *\"$1\": *\([^,]*\),*$/\1/p" "$out/$name.json" | head -1; }
      LC_ALL=C printf '%-12s %9d %9.3f %7.3f %6d %10.2f %9.2f%s\n' "$name" "$(figure vertices)" "$(figure q_avg)" \
        "$(figure q_min)" "$(figure euler)" "$(figure sample)" "$(awk "BEGIN { print $(date +%s.%N) - $start }")" \
        "$([ $status -eq 0 ] || echo "  status $status")"
    done
  done
} 2>&1 | tee "$out/figures.txt"
