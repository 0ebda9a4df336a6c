# Amplitudes over the angle by the highest order of rays, the highest beneath.
set encoding utf8
set logscale y
set grid lc rgb "#dddddd"
set format y "10^{%L}"
set key top right reverse Left
set title sprintf("rays of up to p chords: η = %s, r = 10 µm, λ = 0.6 µm", m)
set xlabel "scattering angle θ, degrees"
set ylabel "(|S_1| + |S_2|) / 2"
set xrange [0:180]
set xtics 30
n = words(orders)
plot for [i = n:1:-1] sprintf("%sorder-%s-%s.tsv", out, m, word(orders, i)) using 1:2 with lines \
	lw (i == n ? 3 : 1.5) lc rgb word("#56b4e9 #009e73 #e69f00 #9400d3 #bbbbbb", i) title "p ≤ ".word(orders, i)
