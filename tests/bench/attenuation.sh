# shellcheck shell=sh
# The paper's attenuation and ours: mean transmittance of Poisson particles at optical depth 2, against C/A, from the kernels' own
# functions, with the standard errors of the measured points and the curves of theory.
# usage, by tests/bench/run: attenuation.sh OUT
out=$1
"${MOTES_TESTS:?the folder of the C tests}/physics/gather" table >attenuation.tsv
cp attenuation.tsv "$out"
cat attenuation.tsv
if ! command -v gnuplot >/dev/null; then
	echo 'bench: attenuation: no charts without gnuplot (make deps)' >&2
	exit 0
fi
cat >attenuation.gp <<'EOG'
set datafile separator "\t"
set grid back lc rgb "#dddddd"
set key top left reverse Left
set title "mean transmittance of random particles, optical depth 2"
set xlabel "C / A: cross section of a particle over that of the query cylinder"
set ylabel "mean transmittance"
set xrange [0:1.05]
set yrange [0.1:0.31]
beer = exp(-2)
bias(x) = exp(-2 / x * (1 - exp(-x)))
plot bias(x) lw 2 lc 1 title "theory of exp(-{/Symbol S} C/A)", beer lw 2 lc 2 title "Beer and Lambert, e^{-2}", \
	"attenuation.tsv" index 1 using 1:3:4 with yerrorbars pt 7 lc 1 title "--attenuation exponential (eq 18)", \
	"attenuation.tsv" index 0 using 1:3:4 with yerrorbars pt 5 lc 2 title "--attenuation product"
EOG
for kind in 'png pngcairo' 'svg svg'; do
	gnuplot -e "set terminal ${kind#* } size 760,520 font 'sans,11' background '#ffffff'; set output 'attenuation.${kind% *}'" attenuation.gp
done
cp attenuation.png attenuation.svg "$out"
