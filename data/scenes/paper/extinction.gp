# Mean square relative error of extinction over size, two indices, rays of 1 and up to 3 chords.
set encoding utf8
set logscale xy
set grid lc rgb "#dddddd"
set format "10^{%L}"
set format x "%g"
set key top right reverse Left
set title "extinction of geometrical optics against Mie's: rays of 3 chords change nothing"
set xlabel "size parameter x"
set ylabel "mean square relative error of C_t"
set xrange [4:1e4]
of(m, p) = sprintf("< awk '$1 == %s' %sextinction-%s.tsv", p, out, m)
colour(m) = m eq word(indices, 1) ? "#e69f00" : "#0072b2"
pale(m) = m eq word(indices, 1) ? "#f7dca0" : "#a0cfe8"
plot for [m in indices] of(m, "3") using 2:3 with lines lw 6 lc rgb pale(m) title "η = ".m.", p ≤ 3 (eq 12)", \
	for [m in indices] of(m, "1") using 2:3 with lines lw 1.5 lc rgb colour(m) title "η = ".m.", p = 1 (eq 14)"
