# shellcheck shell=sh disable=SC2086
# GOA and GOA+ against Lorenz-Mie by direct summation: error against time of a phase function at 1801 angles.
#
# L1:    half the integral over the sphere of |p - p(Mie)|, on a fine grid (0 where Mie takes too long there).
# ns:    CPU time per size and angle of 64 sizes near x (of one for Mie) of one index, norm included, rays found before; models in turn,
#        the least of several. Of this machine and this run: only ratios say something.
# ratio: over Mie's of the same size.
# aim:   us to find the rays of an angle, once for an index.
# Then whole commands for 256 sizes around 3000, 64 around 15000 and 3e4, 1801 angles, in units of mie-phase's direct sum: tools.tsv.
# usage, by tests/bench/run: goa.sh OUT
out=$1
"$MOTES_TESTS/bench/goa" | tee goa.tsv

bench=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/bench/timing
. "$bench/timing"
printf '# m\tx\tcommand\ttime\n' | tee tools.tsv
for m in 1.33 1.5+0.1i; do
	for x in 2900:3100:256 14900:15100:64 29900:30100:64; do
		unit=$(quickest mie-phase --particle $m --size-parameter $x --theta 0:180:0.1)
		for tool in 'goa-phase --model goa' 'goa-phase --model goa+' mie-phase 'mie-phase --tolerance 1e-2'; do
			t=$(quickest $tool --particle $m --size-parameter $x --angles 1801)
			awk -v OFS='\t' -v m=$m -v x="$x" -v tool="$tool" -v t="$t" -v u="$unit" 'BEGIN { print m, x, tool, sprintf("%.3g", t / u) }'
		done
	done
done | tee -a tools.tsv
cp goa.tsv "$out"
cp tools.tsv "$out/goa-tools.tsv"

if ! command -v gnuplot >/dev/null; then
	echo 'bench: goa: no charts without gnuplot (make deps)' >&2
	exit 0
fi
cat >goa.gp <<'EOT'
set datafile separator "\t"
set logscale xy
set grid back lc rgb "#dddddd"
set format "%g"
set key outside bottom center horizontal maxcols 2 reverse Left
set title "phase functions of single sizes at 1801 angles: error against time, by size parameter"
set xlabel "CPU time / Mie's direct sum at the same x"
set ylabel "L1: half the integral of |p - p_{Mie}|"
pick(m, t) = sprintf("< awk -F'\t' -v m='%s' -v t='%s' '$1 == m && $3 == t && $4 > 0' goa.tsv", m, t)
m(i) = (i + 1) / 2
t(i) = (i - 1) % 2 + 1
plot for [i = 1:6] pick(word(M, m(i)), word(T, t(i))) using 6:4 with linespoints lw 2 lc t(i) dt m(i) pt 3 + 2 * m(i) \
	title word(T, t(i)).", m = ".word(M, m(i)), \
	for [i = 1:2] pick(word(M, 1), word(T, i)) using 6:4:(sprintf("%d", $2)) with labels offset 0, 0.8 font ",9" notitle
EOT
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 900,620 font 'sans,11' background '#ffffff'; set output 'goa.${kind% *}'; \
		M = '1.33+0i 1.5+0.1i 0.75+0i'; T = 'goa goa+'" goa.gp
done
cp goa.png goa.svg "$out"
