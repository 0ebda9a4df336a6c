# Pictures of ever more droplets and of the continuous medium.
set encoding utf8
unset tics
unset key
unset border
set size ratio -1
n = words(numbers)
set multiplot
set label 1 at screen 0.5, 0.965 center "droplets of 10 µm in a cube of optical depth 3 a side, and the continuous medium" font ",12"
W = 1.0 / 3
H = W * 810 / 620
do for [k = 1:n + 1] {
	column = (k - 1) % 3
	top = 0.925 - (k > 3) * (H + 0.03)
	set lmargin at screen column * W + 0.005
	set rmargin at screen (column + 1) * W - 0.005
	set tmargin at screen top
	set bmargin at screen top - H + 0.013
	about_k = k > n ? "continuous" : \
		system(sprintf("awk '$1 == \"%s\" { printf \"10^%d in (%%.2g mm)^3: rms %%.3f\", $2, $3 }' %s", word(numbers, k), k + 2, about))
	set label 2 at screen (column + 0.5) * W, top - H - 0.005 center about_k
	plot sprintf("%sgrains-%s.png", out, k > n ? "1e3-continuous" : word(numbers, k)) binary filetype=png with rgbimage
	unset label 1
}
unset multiplot
