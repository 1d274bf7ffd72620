#!/usr/bin/env bash
# Every table of docs/ that a benchmark prints, in one go:
#
#   benches/report.sh > FILE
#
# Hours on an otherwise idle machine, 12 GB of memory. What a table is about is said at the head of its benchmark.
set -eu
cd "$(dirname "$0")/.."

echo "# rubmap $(git describe --tags --always --dirty), $(date -u +%F)"
echo
lscpu | grep -E '^(Model name|CPU\(s\)|Thread|L1d|L2|L3)' | sed 's/^/- /'
echo "- $(rustc --version), $(uname -sr), load $(cut -d' ' -f1 /proc/loadavg)"

run() {
    echo
    echo "## $*"
    echo
    cargo bench --quiet --locked "$@"
}
run --bench step
run --bench reduction -- small medium half paper plain
run --bench reduction -- solve
run --bench steady -- 1e-2 5e-3 1e-3
run --bench stress
run --bench budget
run --bench jobs
run --bench load
run --features cluster --bench cluster
