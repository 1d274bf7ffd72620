#!/usr/bin/env bash
# Times the steps of this tree beside those of another revision, in one run in which both take turns:
#
#   benches/compare.sh [REVISION] [SECTION] [ROUNDS]
#
# builds `cargo bench --bench step` of both and prints, for every row of SECTION (default 900: every scheme in free flight and in
# contact), nanoseconds per step of either (medians) and their ratio. Without REVISION it is the last that is tagged. Needs an
# otherwise idle machine.
set -eu
revision=${1:-$(git describe --tags --abbrev=0)} section=${2:-900} rounds=${3:-7}
here=$(git rev-parse --show-toplevel)
work=$(mktemp -d)
trap 'exit 143' TERM
trap 'git -C "$here" worktree remove --force "$work/then" 2>/dev/null; rm -rf "$work"' EXIT
git -C "$here" worktree add -q --detach "$work/then" "$revision"

binary() {
    (cd "$1" && cargo bench --locked --bench step --no-run --message-format=json 2>/dev/null) |
        sed -n 's/.*"name":"step".*"executable":"\([^"]*\)".*/\1/p'
}
now=$(binary "$here")
then=$(CARGO_TARGET_DIR=$work/target binary "$work/then")

if [ -z "$now" ] || [ -z "$then" ]; then
    echo "the step benchmark of one of the two does not build" >&2
    exit 1
fi

for round in $(seq "$rounds"); do
    "$then" --bench "$section" | sed -n "s/^| $section /then&/p"
    "$now" --bench "$section" | sed -n "s/^| $section /now&/p"
done > "$work/rows"

# Columns: unknowns, motion, scheme, steps/rev, contact, ns/step.
awk -F'|' '
    { key = $3 "|" $4; which = $1; sub(/ *$/, "", which); count[which, key]++; value[which, key, count[which, key]] = $7 + 0
      if (!(key in seen)) { seen[key] = ++keys; name[keys] = key } }
    function median(which, key,    n, i, j, t, v) {
        n = count[which, key]
        for (i = 1; i <= n; i++) v[i] = value[which, key, i]
        for (i = 2; i <= n; i++) for (j = i; j > 1 && v[j] < v[j - 1]; j--) { t = v[j]; v[j] = v[j - 1]; v[j - 1] = t }
        return v[int((n + 1) / 2)]
    }
    END {
        print "| motion | scheme | then, ns/step | now, ns/step | now/then |"
        print "|---|---|---|---|---|"
        for (k = 1; k <= keys; k++) {
            a = median("then", name[k]); b = median("now", name[k])
            if (a > 0 && b > 0) printf "|%s| %.0f | %.0f | %.3f |\n", name[k], a, b, b / a
        }
    }' "$work/rows"
