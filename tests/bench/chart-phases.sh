# shellcheck shell=sh
# Phase functions: error against time by every model, of single sizes and averaged over a distribution of sizes.
#
# p at 8 x + 4001 equal angles, which resolve its finest lobes.
# error: half the integral over the sphere of |p - p(mie-phase --direct)|; of means, against mie-phase's, for --direct takes minutes there.
# time:  CPU time in units of mie-phase's at the same x: of one more size (single), what is found once for an index left out; or of the
#        whole command (average). Of this machine and this run.
# Single: the worst of three sizes x, 1.013 x, 1.037 x. Averaged: 16 classes of a lognormal distribution, median x to 1000, gsd 1.2.
# usage, by tests/bench/run: chart-phases.sh OUT; CHART_SIZES, CHART_INDICES and BENCH_QUICK make it shorter.
out=$1
bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/chart
. "$bench/chart"
sizes=${CHART_SIZES:-30 100 300 1000 3000}
indices=${CHART_INDICES:-1.33 1.5+0.1i}
wavelength=6.283185307179586um    # a radius in um is then x

# tool MODEL
tool() {
	case $1 in
	direct) echo mie-phase --direct ;;
	mie) echo mie-phase ;;
	*) echo goa-phase --model "$1" ;;
	esac
}
# error REFERENCE FILE: of theta and p, with the same angles; the worst of its blocks
error() {
	paste "$1" "$2" | awk '
		{ d = $2 - $4; s += (d < 0 ? -d : d) * sin($1 * pi / 180); n++ }
		$1 == 180 { e = pi * s * pi / (n - 1); if (e > worst) worst = e; s = n = 0 }
		BEGIN { pi = atan2(0, -1) }
		END { printf "%.3g\n", worst }'
}
# one_more LO HI COMMAND..: CPU seconds that a size from LO to HI adds to a run
one_more() {
	range=$1:$2 n=8
	shift 2
	two=$(quickest "$@" --size-parameter "$range:2")
	while t=$(cpu "$@" --size-parameter "$range:$((n + 2))") && awk -v t="$t" -v two="$two" -v e="${BENCH_QUICK:+0.05}" 'BEGIN { exit !(t - two < (e ? e : 0.15)) }'
	do n=$((2 * n)); done
	quickest "$@" --size-parameter "$range:$((n + 2))" | awk -v two="$two" -v n=$n '{ t = $1 - two; printf "%.4g\n", (t > 0 ? t : 0.001) / n }'
}
printf '# m\twhat\tmodel\tx\terror\ttime\n' | tee phases.tsv
for m in $indices; do
	for x in $sizes; do
		angles=$(awk -v x="$x" 'BEGIN { print 8 * x + 4001 }')
		three=$(awk -v x="$x" 'BEGIN { print x "," 1.013 * x "," 1.037 * x }')
		to=$(awk -v x="$x" 'BEGIN { print 1.037 * x }')
		psd lognormal --median "${x}um" --gsd 1.2 --classes 16 -o sizes.psd
		for what in single average; do
			reference=direct
			if [ $what = average ]; then
				[ "$x" -le 1000 ] || continue
				reference=mie
			fi
			for model in direct mie goa incoherent goa+; do
				[ $what = single ] || [ $model != direct ] || continue
				# shellcheck disable=SC2046
				set -- $(tool $model) --particle "$m" --angles "$angles"
				if [ $what = single ]; then
					"$@" --size-parameter "$three" 2>err | tabtxt --columns theta,p | sed 1d >$model.txt
					t=$(one_more "$x" "$to" "$@" 2>err)
				else
					set -- "$@" --wavelength $wavelength --average
					"$@" sizes.psd 2>err | tabtxt --columns theta,p | sed 1d >$model.txt
					t=$(quickest "$@" sizes.psd)
				fi
				echo "$model $(error $reference.txt $model.txt) $t"
			done | awk -v OFS='\t' -v m="$m" -v what=$what -v x="$x" '
				{ name[NR] = $1; e[NR] = $2; t[NR] = $3; if ($1 == "mie") unit = $3 }
				END { for (i = 1; i <= NR; i++) print m, what, name[i], x, e[i], sprintf("%.3g", t[i] / unit) }'
		done
	done
done | tee -a phases.tsv
cat >phases.txt <<'EOT'
Error in L1, half the integral over the sphere of |p - p(mie-phase --direct)|, against CPU time in units of mie-phase's (of one more size; of the
whole command where averaged), at 8 x + 4001 equal angles; single sizes (the worst of x, 1.013 x and 1.037 x), and averaged over a lognormal distribution of gsd 1.2 (against mie-phase's means).
Numbers at the ends are x. What is below 1e-12 is drawn there: the reference has no error here.

    mie-phase [--direct] --particle M --size-parameter X --angles N
    goa-phase --model goa | incoherent | goa+ --particle M --size-parameter X --angles N
    psd lognormal --median X --gsd 1.2 --classes 16 | TOOL --particle M --wavelength 6.283185307179586um --angles N --average

Made by tests/bench/chart-phases.sh (make charts).
EOT
cat >phases.gp <<'EOT'
set datafile separator "\t"
set multiplot layout 2,2 margins 0.08, 0.985, 0.15, 0.955 spacing 0.05, 0.09
set logscale xy
set grid lc rgb "#dddddd"
set format y "10^{%L}"
set format x "%g"
set xrange [0.02:20]
set yrange [3e-13:2]
set ytics 1e-12, 100
models = "direct mie goa incoherent goa+"
titles = "'mie-phase --direct' mie-phase 'goa' 'incoherent' 'goa+'"
colours = "#888888 #000000 #d55e00 #e69f00 #0072b2"
pick(m, what, model) = sprintf("< awk -F'\t' -v OFS='\t' '$1 == \"%s\" && $2 == \"%s\" && $3 == \"%s\" { print $4, ($5 > 1e-12 ? $5 : 1e-12), $6 }' phases.tsv", m, what, model)
ends(m, what, model) = pick(m, what, model)." | sed -n '1p;$p'"
k = 0
do for [m in M] {
	do for [what in "single average"] {
		k = k + 1
		set title (what eq "single" ? "single sizes" : "averaged over sizes").", m = ".m offset 0, -0.7
		if (k % 2) { set ylabel "error in L1 of p" offset 1 } else { unset ylabel }
		if (k > words(M)) { set xlabel "CPU time / mie-phase's at the same x" } else { unset xlabel }
		if (k == 1) { set key at screen 0.5, 0.07 center top vertical maxrows 2 reverse Left samplen 2 } else { unset key }
		from = what eq "single" ? 1 : 2
		plot for [i = from:5] pick(m, what, word(models, i)) using 3:2 with linespoints lw 2 pt 7 ps 0.6 lc rgb word(colours, i) title word(titles, i), \
			for [i = from:5] ends(m, what, word(models, i)) using 3:2:1 with labels offset 1.2, 0.4 font ",8" textcolor rgb word(colours, i) notitle
	}
}
unset multiplot
EOT
draw phases 1000,860 "M = '$indices'"
