# Both amplitudes over the angle, a row a radius: Mie theory beneath, GOA and GOA+ above.
set encoding utf8
set logscale y
set grid lc rgb "#dddddd"
set format y "10^{%L}"
set xrange [0:180]
set xtics 45
n = words(radii)
set multiplot layout n,2 title sprintf("η = %s, λ = 0.6 µm", m)
of(r, t) = sprintf("%samplitudes-%s-%s-%s.tsv", out, m, r, t)
do for [k = 1:n] {
	r = word(radii, k)
	do for [j = 1:2] {
		set title sprintf("|S_%d|, r = %s µm", j, r)
		if (k == n) { set xlabel "scattering angle θ, degrees" }
		if (k > 1 || j > 1) { unset key } else { set key top right }
		w = k > 3 ? 0.7 : 1.5
		plot of(r, "mie") using 1:1 + j with lines lw w * 3 lc rgb "#aaaaaa" title "Mie", \
			of(r, "goa") using 1:1 + j with lines lw w lc rgb "#d55e00" title "GOA", \
			of(r, "plus") using 1:1 + j with lines lw w lc rgb "#0072b2" title "GOA+"
	}
}
unset multiplot
