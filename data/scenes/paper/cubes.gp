# Pictures of the cube side by side, Mie above and GOA below, the rms difference of a column beneath.
set encoding utf8
unset tics
unset key
unset border
set size ratio -1
n = words(radii)
set multiplot
set label 1 at screen 0.5, 0.97 center sprintf("a cube of optical depth 8 a side, η = %s, λ = 0.6 µm", m) font ",12"
W = 0.95 / n
H = W * 1060 / 600
left(k) = 0.04 + (k - 1) * W
do for [k = 1:n] {
	r = word(radii, k)
	do for [j = 0:1] {
		set lmargin at screen left(k)
		set rmargin at screen left(k) + W - 0.004
		set tmargin at screen 0.905 - j * H
		set bmargin at screen 0.905 - (j + 1) * H + 0.007
		if (j == 0) {
			set label 2 at screen left(k) + W / 2, 0.93 center "r = ".r." µm"
			set label 3 at screen left(k) + W / 2, 0.03 center \
				system(sprintf("awk '$1 == %s { printf \"rms %%.4f (noise %%.4f)\", $2, $3 }' %s", r, rms))
			set label 4 at screen 0.02, 0.905 - (k == 1 ? 0.5 : 9) * H rotate by 90 center "Mie"
			set label 5 at screen 0.02, 0.905 - (k == 1 ? 1.5 : 9) * H rotate by 90 center "GOA"
		} else {
			unset label
		}
		plot sprintf("%scube-%s-%s-%s.png", out, m, r, j ? "goa" : "mie") binary filetype=png with rgbimage
	}
}
unset multiplot
