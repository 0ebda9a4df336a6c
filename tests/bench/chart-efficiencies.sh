# shellcheck shell=sh
# Efficiencies by every method of xsect: error against time, from x = 0.01 to 1e5.
#
# error: the worst over 256 sizes from x to 1.1 x: the larger of the relative errors of Q_ext and Q_sca and the error of g, against
#        Mie's; where the two are equal, what xsect estimates for Mie's.
# time:  CPU time of a size among many, the table written, in units of Mie's at x = 100 of the same m. Of this machine and this run.
# usage, by tests/bench/run: chart-efficiencies.sh OUT; CHART_SIZES, CHART_INDICES, CHART_METHODS and BENCH_QUICK make it shorter.
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/chart
. "$bench/chart"
sizes=${CHART_SIZES:-0.01 0.1 1 10 100 1000 1e4 1e5}
indices=${CHART_INDICES:-1.33 1.49 1.5+0.1i 0.75}
methods=${CHART_METHODS:-mie,goa,cam,evans-fournier,rayleigh,auto --tolerance 1e-1,auto --tolerance 1e-2,auto --tolerance 1e-3,auto --tolerance 1e-6}

# efficiencies LO HI METHOD M: q_ext, q_sca, g and the estimated error of 256 sizes
efficiencies() {
	# shellcheck disable=SC2086
	xsect --method $3 --particle "$4" --size-parameter "$1:$2:256" 2>err | tabtxt --columns q_ext,q_sca,g,error | sed 1d
}
printf '# m\tmethod\tx\terror\ttime\n' | tee efficiencies.tsv
for m in $indices; do
	unit=$(per_size 100 110 xsect --method mie --particle "$m")
	for x in $sizes; do
		to=$(awk -v x="$x" 'BEGIN { print 1.1 * x }')
		efficiencies "$x" "$to" mie "$m" >mie.txt
		echo "$methods" | tr , '\n' | while read -r method; do
			efficiencies "$x" "$to" "$method" "$m" >got.txt
			if ! [ -s got.txt ]; then
				echo "bench: efficiencies: $method, m = $m, x = $x: $(head -n 1 err)" >&2
				continue
			fi
			# shellcheck disable=SC2086
			t=$(per_size "$x" "$to" xsect --method $method --particle "$m" 2>err)
			paste mie.txt got.txt | awk -v OFS='\t' -v m="$m" -v method="$method" -v x="$x" -v t="$t" -v unit="$unit" '
				function off(d) { if (d < 0) d = -d; if (d > worst) worst = d }
				$1 == $5 && $2 == $6 && $3 == $7 { off($4); next }
				{ off($5 / $1 - 1); off($6 / $2 - 1); off($7 - $3) }
				BEGIN { sub(/--tolerance /, "", method) }
				END { print m, method, x, sprintf("%.3g", worst), sprintf("%.3g", t / unit) }'
		done
	done
done | tee -a efficiencies.tsv
cat >efficiencies.txt <<'EOT'
Error against time of xsect's methods. A point is many sizes of one index from x to 1.1 x; numbers at points are powers of 10: 3 is x = 1000.
error: worst, of 256 sizes, of the relative errors of Q_ext and Q_sca and the error of g, against --method mie, whose own is its estimate.
time: CPU time of a size in units of --method mie at x = 100, the least of three runs on one thread.

    xsect --method METHOD [--tolerance T] --particle M --size-parameter X:1.1X:N | tabtxt --columns q_ext,q_sca,g,error

Made by tests/bench/chart-efficiencies.sh (make charts).
EOT
cat >efficiencies.gp <<'EOT'
set datafile separator "\t"
set multiplot layout 2,2 margins 0.075, 0.99, 0.145, 0.965 spacing 0.055, 0.075
set logscale xy
set grid lc rgb "#dddddd"
set format y "10^{%L}"
set format x "%g"
set xrange [0.1:3e4]
set yrange [1e-15:30]
set ytics 1e-14, 100
methods = "mie goa cam evans-fournier rayleigh"
colours = "#000000 #d55e00 #009e73 #cc79a7 #e69f00"
exponents = "1 2 3 6"
blues = "#b5d8f0 #74b3e0 #2f7fc1 #08306b"
pick(m, name) = sprintf("< awk -F'\t' -v OFS='\t' '$1 == \"%s\" && $2 == \"%s\" { print $3, ($4 > 20 ? 20 : $4), $5 }' efficiencies.tsv", m, name)
do for [k = 1:words(M)] {
	m = word(M, k)
	set title "m = ".m offset 0, -0.7
	if (k % 2) { set ylabel "error of Q_{ext}, Q_{sca}, g" offset 1.5 } else { unset ylabel }
	if (k > 2) { set xlabel "time of a size / Mie's at x = 100" } else { unset xlabel }
	if (k == 1) { set key at screen 0.5, 0.085 center top vertical maxrows 3 reverse Left samplen 2 } else { unset key }
	plot for [i = 1:5] pick(m, word(methods, i)) using 3:2 with linespoints lw 1.5 pt 7 ps 0.5 lc rgb word(colours, i) title word(methods, i), \
		for [i = 1:5] pick(m, word(methods, i)) using 3:2:(sprintf("%.0f", log10($1))) with labels offset 0.9, 0.5 font ",8" \
			textcolor rgb word(colours, i) notitle, \
		for [i = 1:4] pick(m, "auto 1e-".word(exponents, i)) using 3:2 with points pt 6 ps 2.4 - 0.35 * i lw 2 lc rgb word(blues, i) title "auto, T = 1e-".word(exponents, i), \
		for [i = 1:4] 10.0**-int(word(exponents, i)) with lines dt 2 lc rgb word(blues, i) notitle
}
unset multiplot
EOT
draw efficiencies 1000,900 "M = '$indices'"
