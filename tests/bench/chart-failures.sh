# shellcheck shell=sh
# Where each method fails: extinction of every method over size, with the region where GOA's is negative, and a rainbow and a glory close up.
# usage, by tests/bench/run: chart-failures.sh OUT; CHART_STEPS, of sizes in the chart of extinction, make it shorter
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/chart
. "$bench/chart"
m=1.33
methods='mie goa cam evans-fournier rayleigh'
# x, then Q_ext by each of the methods
for method in $methods; do
	xsect --method "$method" --particle $m --size-parameter "0.01:1e4:${CHART_STEPS:-1200}" 2>err | tabtxt --columns x,q_ext | sed 1d >"$method.txt"
done
{
	printf '# x\tQ_ext by %s\n' "$methods"
	for method in $methods; do cut -f2 "$method.txt" >"$method.q"; done
	cut -f1 mie.txt | paste - mie.q goa.q cam.q evans-fournier.q rayleigh.q
} >failures.tsv
# blocks of theta, then p by each of the models: x = 1000, a rainbow; x = 1000, the glory
for angles in 132:150:0.02 176:180:0.005; do
	mie-phase --particle $m --size-parameter 1000 --theta $angles | tabtxt --columns theta,p | sed 1d >mie.txt
	for model in goa incoherent goa+; do
		goa-phase --model $model --particle $m --size-parameter 1000 --theta $angles | tabtxt --columns p | sed 1d >"$model.txt"
	done
	printf '\n\n# theta\tp by mie-phase, goa, incoherent, goa+\n'
	paste mie.txt goa.txt incoherent.txt goa+.txt
done >>failures.tsv
cat >failures.txt <<'EOT'
Above: Q_ext of m = 1.33 by every method, and its relative error against Mie theory. GOA's is negative where the ground is shaded.
Below: the primary rainbow and the glory of x = 1000 by Mie theory, GOA (rays and diffraction), without interference, and GOA+.

    xsect --method METHOD --particle 1.33 --size-parameter 0.01:1e4:1200 | tabtxt --columns x,q_ext
    mie-phase --particle 1.33 --size-parameter 1000 --theta 132:150:0.02 | tabtxt --columns theta,p     (and 176:180:0.005)
    goa-phase --model goa | incoherent | goa+ (the same)

Made by tests/bench/chart-failures.sh (make charts).
EOT
cat >failures.gp <<'EOT'
set datafile separator "\t"
set multiplot layout 2,2 margins 0.07, 0.985, 0.075, 0.955 spacing 0.08, 0.11
set grid lc rgb "#dddddd"
methods = "Mie GOA CAM Evans-Fournier Rayleigh"
colours = "#000000 #d55e00 #009e73 #cc79a7 #e69f00"
negative = "failures.tsv"
stats negative index 0 using ($3 < 0 ? $1 : NaN) nooutput
set logscale x
set xrange [0.01:1e4]
set format x "10^{%L}"
set xlabel "size parameter x"
set title "extinction, m = 1.33" offset 0, -0.7
set ylabel "Q_{ext}"
set yrange [-2:6]
set object 1 rectangle from STATS_min, graph 0 to STATS_max, graph 1 fc rgb "#fbe3d6" fs solid noborder behind
set label 1 "GOA below 0" at sqrt(STATS_min * STATS_max), -1.5 center textcolor rgb "#d55e00"
set key top right reverse Left samplen 2 font ",10"
width(i) = i == 1 ? 4 : 1.5
shade(i) = i == 1 ? "#999999" : word(colours, i)
plot for [i = 1:5] "failures.tsv" index 0 using 1:1 + i with lines lw width(i) lc rgb shade(i) title word(methods, i)
unset object
unset label
set title "its error against Mie theory"
set ylabel "relative error of Q_{ext}"
set logscale y
set yrange [1e-9:1e4]
set format y "10^{%L}"
set ytics 1e-8, 100
set key bottom left
plot for [i = 2:5] "failures.tsv" index 0 using 1:(abs(column(1 + i) / $2 - 1)) with lines lw 1.5 lc rgb shade(i) title word(methods, i)
unset logscale x
set format x "%g"
set ytics auto
set xlabel "scattering angle, degrees"
set ylabel "p, sr^{-1}"
models = "Mie GOA incoherent GOA+"
tints = "#999999 #d55e00 #e69f00 #0072b2"
set xrange [132:150]
set yrange [3e-4:0.3]
set title "the primary rainbow, x = 1000"
set key top left
plot for [i = 1:4] "failures.tsv" index 1 using 1:1 + i with lines lw width(i) lc rgb word(tints, i) title word(models, i)
set xrange [176:180]
set yrange [3e-4:0.3]
set title "the glory, x = 1000"
plot for [i = 1:4] "failures.tsv" index 2 using 1:1 + i with lines lw width(i) lc rgb word(tints, i) title word(models, i)
unset multiplot
EOT
draw failures 1000,860
