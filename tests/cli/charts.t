#!/bin/sh
# The charts of make charts, small: their scripts still read what the tools write; and the figures of the paper are all known how to make.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
export BENCH_QUICK=1 CHART_INDICES=1.33
draw() { sh "$top/tests/bench/run" "$tmp/out" "$1" >"$tmp/log" 2>&1; }

CHART_SIZES='1 100' CHART_METHODS='mie,rayleigh,auto --tolerance 1e-2' draw chart-efficiencies
is 'mie 1 rayleigh 1 auto 1e-2 1 mie 100 rayleigh 100 auto 1e-2 100' "$(awk -F'\t' 'NR > 1 { print $2, $3 }' "$tmp/out/efficiencies.tsv" | paste -sd' ' -)" \
	'efficiencies: methods by size'
awk -F'\t' 'NR > 1 && (!($4 > 0 && $5 > 0) || $2 == "auto 1e-2" && $4 > 1e-2 || $2 == "mie" && $4 > 1e-11) { bad = 1 } END { exit bad }' "$tmp/out/efficiencies.tsv"
ok $? 'efficiencies: errors and times, auto within its tolerance'
CHART_SIZES=40 draw chart-phases
awk -F'\t' 'NR > 1 && ($4 != 40 || !($6 > 0) || ($3 == "goa" ? $5 < 0.01 || $5 > 0.5 : $3 == "mie" && $5 > 1e-10)) { bad = 1 } END { exit bad || NR != 10 }' "$tmp/out/phases.tsv"
ok $? 'phases: five models, single and averaged'
CHART_STEPS=6 draw chart-cheapest
awk -F'\t' '/^[^#]/ { n++; if ($2 > $3 || $4 !~ /^[1-5]$/) bad = 1 } END { exit bad || n < 16 }' "$tmp/out/cheapest.tsv"
ok $? 'cheapest: a method for every size and index'
CHART_STEPS=200 draw chart-failures
awk -F'\t' 'NR > 1 && NR < 202 && $3 < 0 && $1 < 2 { below++ } /^#/ { blocks++ } END { exit !(below > 50 && blocks == 3) }' "$tmp/out/failures.tsv"
ok $? 'failures: extinction of geometrical optics below 0, and two close-ups'
is '8' "$(make -n -C "$top/data/scenes/paper" OUT="$tmp/paper" 2>&1 | grep -c '^gnuplot')" 'the figures of the paper'
done_testing
