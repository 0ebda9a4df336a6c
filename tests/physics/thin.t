#!/bin/sh
# Thin media: no pixel is black by chance, nothing is biased, and what is seen through them is exact.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"
# shellcheck source=tests/support/render.sh
. "$top/tests/support/render.sh"

far() {
	echo "camera = { position = [0.0, 0.0, 1000.0]; target = [0.0, 0.0, 0.0]; fov = 0.1; resolution = [8, 8]; };
		medium = { file = \"$2\"; }; $3" >"$1"
}
is_near() { awk -v a="$1" -v b="$2" -v e="$3" 'BEGIN { d = a / b - 1; exit !(a ~ /[0-9]/ && d <= e && d >= -e) }'; }

{ printf '# wavelength:f64:um\ttheta:f64:deg\tp:f64:sr^-1\n'; for w in 0.45 0.55 0.65; do hg_rows 0 '' $w; done; } | txttab >iso.phase
# a parallel sun from +x of irradiance 4 pi: what is scattered once is (1 - e^-tau) times the mean of e^-s(1 - x) over what is seen, s the
# extinction, tau twice that; wavelengths have 1, 1.1 and 1.2 times the first
sun='lights = ( { type = "sun"; direction = [-1, 0, 0]; irradiance = 12.566370614; } );'
want() { awk -v s="$1" 'BEGIN { w = 0.872665; x = s * w; print (1 - exp(-2 * s)) * exp(-s) * (x > 1e-3 ? (exp(x) - exp(-x)) / 2 / x : 1 + x * x / 6) }'; }
one_size
for s in 1e-7 1e-4 0.02; do
	dispersed "$(awk -v s=$s 'BEGIN { print s * 1e6 }')" 1 0.45 0.55 0.65 >x.xsect
	bake() { medium-bake --xsect x.xsect --phase iso.phase "$@"; }
	bake --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m --voxels 4 -o thin.medium
	# eight million particles, as many in each of 64 cubes but for their own chance
	dispersed "$(awk -v s=$s 'BEGIN { print s * 8e12 / 64000 }')" 1 0.45 0.55 0.65 >x.xsect
	awk 'BEGIN { print "# x:f64:m\ty:f64:m\tz:f64:m\tradius:f64:um"; for (i = 0; i < 64000; i++)
		print (i % 40 + 0.5) / 20 - 1 "\t" (int(i / 40) % 40 + 0.5) / 20 - 1 "\t" (int(i / 1600) + 0.5) / 20 - 1 "\t1000" }' | txttab |
		bake --box 2m,2m,2m --voxels 4 -o thin-grains.medium
	for m in 'continuous thin' 'grid thin' 'grid thin-grains'; do
		far thin.scene "${m#* }.medium" "$sun"
		for seed in 1 2; do vrender thin.scene --transport "${m% *}" --samples 4096 --seed $seed -o thin$seed.exr; done
		# chance alone would have a relative error of (4096 x 2 s)^-1/2, 1.1 at s = 1e-4
		error=$(channels rms thin1.exr G - thin2.exr G | awk -v m="$(channels mean thin1.exr G)" '{ print $1 / sqrt(2) / m }')
		[ $s = 1e-7 ] && most=0.6 || most=0.03
		awk -v e="$error" -v most="$most" 'BEGIN { exit !(e < most) }'
		ok $? "$m, $s/m: a pixel's relative error $error"
		for c in 'R 1.2' 'G 1.1' 'B 1.0'; do
			want=$(want "$(awk -v s=$s -v f="${c#* }" 'BEGIN { print s * f }')")
			got=$(channels mean thin1.exr "single.${c% *}")
			is_near "$got" "$want" "$([ $s = 1e-7 ] && echo 0.3 || echo 2e-3)"
			ok $? "$m, $s/m: single.${c% *} $got, wanted $want"
			want=$(awk -v t="$s" -v f="${c#* }" 'BEGIN { t *= 2 * f; print t < 1e-4 ? t * (1 - t / 2) : 1 - exp(-t) }')
			got=$(channels mean thin1.exr "A${c% *}")
			is_near "$got" "$want" "$([ $s = 1e-7 ] && echo 0.01 || echo 1e-4)"
			ok $? "$m, $s/m: A${c% *} $got, wanted $want"
		done
		# a sample's alpha of 2e-7 is 200 of the film's units, its depth is rounded to these
		got=$(channels mean thin1.exr depth.Z)
		near "$got" 1000 "$([ $s = 1e-7 ] && echo 5 || echo 0.08)"
		ok $? "$m, $s/m: mean depth $got"
		far thin.scene "${m#* }.medium" ''
		vrender thin.scene --transport "${m% *}" --samples 16 -o white.exr
		# of the middle wavelength each pixel, of the others, whose weights differ by flight, the mean: 5 standard errors at 0.02
		is_near "$(channels min white.exr G)" 1 2e-5 && is_near "$(channels max white.exr G)" 1 2e-5 &&
			is_near "$(channels mean white.exr R)" 1 5e-5 && is_near "$(channels mean white.exr B)" 1 5e-5
		ok $? "$m, $s/m: white is white"
	done
done
# in front of a lamp: what comes through is exact in every pixel; the ground's light is as it was
xsections '100 0' >one.xsect
hg 0 >one.phase
medium-bake --xsect one.xsect --phase one.phase --psd one.psd --concentration 1e6/m3 --box 2m,2m,2m -o black.medium
far lamp.scene black.medium 'lights = ( { type = "quad"; corner = [-9.0, -9.0, -3.0]; edge1 = [18.0, 0.0, 0.0]; edge2 = [0.0, 18.0, 0.0]; radiance = 1.0; } );'
vrender lamp.scene --samples 16 -o lamp.exr
low=$(channels min lamp.exr G) high=$(channels max lamp.exr G)
near "$low" 0.99980002 2e-7 && near "$high" 0.99980002 2e-7
ok $? "a lamp behind a thin black medium: $low to $high"
done_testing
