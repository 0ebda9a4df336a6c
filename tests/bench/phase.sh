# shellcheck shell=sh
# Phase functions: error against time, of the table that mie-phase and goa-phase write by default.
#
# error: half the integral over the sphere of |p - q|: p is the table, linear between its angles as medium-bake takes it, q is
#        Lorenz-Mie theory on one fine grid, equal steps that oversample its finest lobes 4 times. mie-phase's own error is
#        therefore that of its default grid.
# model: the same error of the tool's p on that fine grid itself, without the table's.
# time:  CPU time of a size, start of the program left out, in units of mie-phase for the first size of the same m.
# ratio: the same in units of mie-phase for the same size: below 1 is faster.
# Times are of this machine and this run; only their ratios are kept.
# usage, by tests/bench/run: phase.sh OUT
out=$1
sizes='30.49 100.49 300.49 1000.49 3000.49 10000.49'     # between the resonances, which sit elsewhere for every m

bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/timing
. "$bench/timing"

# a_size TOOL M X: seconds for one size, from so many of them in one run that the clock's ticks of 10 ms are fine enough; the
# least of three such runs, since whatever else the machine does only adds.
a_size() {
	n=1
	list=$3
	while t=$(cpu "$1" --particle "$2" --size-parameter "$list") && awk -v t="$t" 'BEGIN { exit t >= 0.3 }'; do
		n=$((2 * n))
		list=$list,$list
	done
	u=$(cpu "$1" --particle "$2" --size-parameter "$list")
	v=$(cpu "$1" --particle "$2" --size-parameter "$list")
	echo "$t $u $v $n" | awk '{ t = $1; if ($2 < t) t = $2; if ($3 < t) t = $3; printf "%.4g\n", t / $4 }'
}

# error TABLE: against fine.txt, the reference in equal steps.
error() {
	tabtxt --columns theta,p "$1" >table.txt
	awk -v steps="$steps" '
		FILENAME == "table.txt" { if (FNR > 1) { t[n] = $1; p[n++] = $2 }; next }
		FNR > 1 {
			while (i + 2 < n && t[i + 1] < $1) i++
			d = p[i] + (p[i + 1] - p[i]) * ($1 - t[i]) / (t[i + 1] - t[i]) - $2
			sum += (d < 0 ? -d : d) * sin($1 * pi / 180)
		}
		BEGIN { pi = atan2(0, -1); i = 0 }
		END { printf "%.3g\n", pi * sum * pi / steps }' table.txt fine.txt
}

printf '# m\tx\ttool\tangles\terror\tmodel\ttime\tratio\n' | tee phase.tsv
for m in 1.33 1.5+0.1i; do
	unit=
	for x in $sizes; do
		steps=$(awk -v x="$x" 'BEGIN { print 2 * int(4 * x + 2000) }')
		mie-phase --particle "$m" --size-parameter "$x" --angles $((steps + 1)) | tabtxt --columns theta,p >fine.txt
		for tool in mie-phase goa-phase; do
			$tool --particle "$m" --size-parameter "$x" -o one.tab
			t=$(a_size $tool "$m" "$x")
			[ $tool = goa-phase ] || mie=$t
			: "${unit:=$t}"
			e=$(error one.tab)
			angles=$(($(wc -l <table.txt) - 1))
			model=0
			if [ $tool = goa-phase ]; then
				$tool --particle "$m" --size-parameter "$x" --angles $((steps + 1)) -o one.tab
				model=$(error one.tab)
			fi
			awk -v OFS='\t' -v m="$m" -v x="$x" -v tool=$tool -v n=$angles -v e="$e" -v model="$model" -v t="$t" -v mie="$mie" -v unit="$unit" \
				'BEGIN { print m, x, tool, n, e, model, sprintf("%.3g", t / unit), sprintf("%.3g", t / mie) }'
		done
	done
done | tee -a phase.tsv

cp phase.tsv "$out"
if ! command -v gnuplot >/dev/null; then
	echo 'bench: phase: no charts without gnuplot (make deps)' >&2
	exit 0
fi
cat >phase.gp <<'EOT'
set datafile separator "\t"
set multiplot layout 1,2
set logscale xy
set grid back lc rgb "#dddddd"
set format "%g"
set key outside bottom center horizontal maxcols 2 reverse Left
set title "error against time, by size parameter"
set xlabel "CPU time / mie-phase at x = 30.49"
set ylabel "error: half the integral of |p - p_{Mie}|"
set xrange [0.5:*]
pick(m, t) = sprintf("< awk -F'\t' -v m='%s' -v t=%s '$1 == m && $3 == t' phase.tsv", m, t)
m(i) = (i + 1) / 2
t(i) = (i - 1) % 2 + 1
plot for [i = 1:4] pick(word(M, m(i)), word(T, t(i))) using 7:5 with linespoints lw 2 lc t(i) dt m(i) pt 3 + 2 * m(i) \
	title word(T, t(i)).", m = ".word(M, m(i)), \
	for [i = 1:2] pick(word(M, 1), word(T, i)) using 7:5:(sprintf("%d", $2)) with labels offset 0, 0.8 font ",9" notitle
set title "time against size"
set xlabel "size parameter x"
set ylabel "CPU time / mie-phase at the same x"
set xrange [20:20000]
plot for [i = 1:2] pick(word(M, i), "goa-phase") using 2:8 with linespoints lw 2 lc 2 dt i pt 3 + 2 * i title "goa-phase, m = ".word(M, i), \
	1 with lines lw 2 lc 1 title "mie-phase"
unset multiplot
EOT
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 1200,520 font 'sans,11' background '#ffffff'; set output 'phase.${kind% *}'; \
		M = '1.33 1.5+0.1i'; T = 'mie-phase goa-phase'" phase.gp
done
cp phase.png phase.svg "$out"
