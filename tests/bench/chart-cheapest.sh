# shellcheck shell=sh
# The method that xsect --method auto takes, over size and index, at four tolerances: what it holds for the cheapest that is good enough.
# usage, by tests/bench/run: chart-cheapest.sh OUT; CHART_STEPS makes it shorter.
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/chart
. "$bench/chart"
steps=${CHART_STEPS:-180}

# ask T V M: V is the value on the map's axis, M the index
ask() {
	xsect --tolerance "$1" --particle "$3" --size-parameter "0.01:1e5:$steps" | tabtxt --columns x,method |
		awk -v OFS='\t' -v t="$1" -v v="$2" 'NR > 1 { print t, v, $1, $2 }'
}
# map FROM TO RATIO INDEX: v evenly spaced in the logarithm, the index as awk's sprintf has it of v
map() {
	for t in 1e-1 1e-2 1e-3 1e-6; do
		awk -v a="$1" -v b="$2" -v n=$((steps / 3)) -v index_of="$3" 'BEGIN {
			for (i = 0; i < n; i++) { v = a * (b / a)^((i + 0.5) / n); printf "%.6g " index_of "\n", v, v } }' |
			while read -r v m; do ask $t "$v" "$m"; done
		echo
		echo
	done
}
{
	map 0.5 2.5 '%.6g'
	map 1e-4 1 '1.5+%.6gi'
} >answers.tsv
# neighbours of one method together
printf '# n, or k of 1.5+ik\tfrom x\tto x\tmethod: 1 mie, 2 rayleigh, 3 goa, 4 cam, 5 evans-fournier; a block a tolerance\n' >cheapest.tsv
awk -F'\t' -v OFS='\t' '
	function put() { if (n) print v, from, to, method; n = 0 }
	$2 != v || $4 != method { put(); v = $2; from = $3; method = $4 }
	{ if (NF) { to = $3; n = 1 } else print "" }
	END { put() }' answers.tsv >>cheapest.tsv
cat >cheapest.txt <<'EOT'
The method that auto takes for a sphere of the size parameter x and the refractive index n, or 1.5+ik, at four tolerances: the cheapest
whose estimated error, the larger of those of Q_ext, Q_sca (relative) and g, is within the tolerance, where many sizes of one index are wanted, as here (xsect(1)).

    xsect --tolerance T --particle M --size-parameter 0.01:1e5:180 | tabtxt --columns x,method

Made by tests/bench/chart-cheapest.sh (make charts).
EOT
cat >cheapest.gp <<'EOT'
set datafile separator "\t"
set multiplot layout 2,4 margins 0.075, 0.995, 0.17, 0.94 spacing 0.012, 0.08
set logscale x
unset key
unset colorbox
set xrange [0.01:1e5]
set xtics ("0.01" 0.01, "1" 1, "100" 100, "10^4" 1e4)
set tics out nomirror
set cbrange [0.5:5.5]
set palette maxcolors 5 defined (1 "#444444", 2 "#e69f00", 3 "#d55e00", 4 "#009e73", 5 "#cc79a7")
names = "Mie Rayleigh GOA CAM Evans-Fournier"
colours = "#444444 #e69f00 #d55e00 #009e73 #cc79a7"
do for [k = 1:5] {
	set object k rectangle at screen 0.165 * k - 0.035, 0.045 size screen 0.018, 0.025 fc rgb word(colours, k) fs solid noborder
	set label k word(names, k) at screen 0.165 * k - 0.02, 0.045 left
}
do for [row = 0:1] {
	set logscale y
	if (row) { set yrange [1e-4:1]; set ytics ("10^{-4}" 1e-4, "10^{-2}" 1e-2, "1" 1) } else { set yrange [0.5:2.5]; set ytics (0.5, 0.75, 1, 1.33, 2) }
	do for [k = 0:3] {
		if (row) { unset title; set xlabel "x" offset 0, 0.6; set format x } else { set title "T = ".word("1e-1 1e-2 1e-3 1e-6", k + 1) offset 0, -0.6; unset xlabel }
		if (k) { set format y ""; unset ylabel } else { set ylabel (row ? "k of m = 1.5 + ik" : "m = n") offset 1.5 }
		if (k) { set ytics ("" 1) }
		# every answer fills its cell, and a little of the next
		rx = 1e7**(0.6 / (STEPS - 1))
		ry = (row ? 1e4 : 5.0)**(0.6 / (STEPS / 3))
		plot "cheapest.tsv" index row * 4 + k using 2:1:($2 / rx):($3 * rx):($1 / ry):($1 * ry):4 with boxxyerror fs solid noborder lc palette
	}
}
unset multiplot
EOT
draw cheapest 1000,640 "STEPS = $steps"
