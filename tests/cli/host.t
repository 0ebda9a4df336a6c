#!/bin/sh
# A host that absorbs: reference cross sections through the tools, coefficients streamed, the warning, what is refused.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# Every reference row within 1e-11. The index is written as the row has it.
awk -F, 'NR > 1 { print $1, $2, $3 "+" $4 "i", $5 "+" $6 "i", $7, $8 }' "$data/mie_absorbing_host.csv" >rows
while read -r wavelength radius particle host ext sca; do
	xsect --method mie --particle "$particle" --host "$host" --wavelength "${wavelength}um" --radius "${radius}um" 2>>warnings |
		tabtxt --columns c_ext,c_sca | awk -v ext="$ext" -v sca="$sca" 'NR > 1 { print $1 / ext - 1, $2 / sca - 1 }'
done <rows >errors
is '32 0' "$(awk '{ for (i = 1; i <= 2; i++) if (!($i < 1e-11 && $i > -1e-11)) bad++ } END { print NR, bad + 0 }' errors)" \
	'32 rows of reference cross sections, within 1e-11'
is "$(awk -F, 'NR > 1 && ($7 <= 0 || $9 > 1)' "$data/mie_absorbing_host.csv" | wc -l)" "$(wc -l <warnings)" \
	'one warning for each row with beta > 1 or negative extinction'

# Coefficients streamed give what is computed at once, to the last bit.
printf '# radius:f64:um\tweight:f64:1\n0.01\t0.5\n0.3\t0.3\n1\t0.15\n10\t0.05\n' | txttab >sizes.tab
for m in 1.5 1.33+1e-8i 1.5+0.1i; do
	options="--particle $m --host 1.33+0.01i --wavelength 450nm,650nm"
	# shellcheck disable=SC2086
	{
		xsect $options sizes.tab 2>direct.err | tabtxt >direct
		mie-coeffs $options sizes.tab -o c.tab 2>err
		xsect c.tab 2>streamed.err | tabtxt >streamed
		cmp -s direct streamed && cmp -s direct.err streamed.err && [ "$(wc -l <direct)" -eq 9 ]
		ok $? "mie-coeffs | xsect, $m"
		for angles in '--angles 37' '' --average; do
			mie-phase $options $angles sizes.tab 2>>err | tabtxt >direct
			mie-phase $angles c.tab 2>>err | tabtxt >streamed
			cmp -s direct streamed && [ "$(wc -l <direct)" -gt 37 ]
			ok $? "mie-coeffs | mie-phase $angles, $m"
		done
		is '0 1' "$(grep -vc 'few for the forward peak' err) $(wc -l <direct.err)" 'one warning by xsect, none by the others'
	}
done
xsect --particle 1.5 --host 1.33+0.01i --size-parameter 3,10,30 | tabtxt >direct
mie-coeffs --particle 1.5 --host 1.33+0.01i --size-parameter 3,10,30 | xsect | tabtxt >streamed
cmp -s direct streamed
ok $? 'and by size parameter'
for n in 1 3; do mie-phase --threads $n --particle 1.5 --host 1.33+0.01i --wavelength 550nm sizes.tab | cksum >threads.$n; done
is "$(cat threads.1)" "$(cat threads.3)" 'the same bytes with 1 and 3 threads'

# The size parameter is that of the real part of the host.
x=$(awk 'BEGIN { printf "%.17g", 8 * atan2(1, 1) * 1.33 / 0.55 }')
xsect --particle 1.5 --host 1.33+0.01i --size-parameter "$x" | tabtxt --columns q_ext,q_sca,g | sed 1d >by_x
xsect --particle 1.5 --host 1.33+0.01i --wavelength 550nm --radius 1um | tabtxt --columns c_ext,c_sca,g | sed 1d >by_radius
ok "$(paste by_x by_radius | awk '{ pi = 4 * atan2(1, 1); e = ($4 / $1 / pi - 1) ^ 2 + ($5 / $2 / pi - 1) ^ 2 + ($6 / $3 - 1) ^ 2; print !(e < 1e-26) }')" \
	'--size-parameter is 2 pi r Re(host) / wavelength'
xsect --particle 1.5 --host 1.33+0.01i --size-parameter 10 | tabtxt --columns q_sca,q_back | sed 1d >back
mie-phase --particle 1.5 --host 1.33+0.01i --size-parameter 10 --theta 180 | tabtxt --columns p | sed 1d >at_180
ok "$(paste back at_180 | awk '{ e = 16 * atan2(1, 1) * $1 * $3 / $2 - 1; print !(e < 1e-13 && e > -1e-13) }')" 'q_back is 4 pi q_sca p(180)'

# A host that absorbs at some wavelengths only: each is computed as alone.
xsect --particle 1.5 --host water --wavelength 500nm,1200nm,2um --radius 1um | tabtxt | sed 1d >mixed
for w in 500nm 1200nm 2um; do xsect --particle 1.5 --host water --wavelength $w --radius 1um | tabtxt | sed 1d; done >each
is "$(cat each)" "$(cat mixed)" 'wavelengths of one host do not depend on each other'

# The warning names the worst.
xsect --particle 1.5+0.1i --host 1.33+0.01i --wavelength 550nm --radius 0.5um,30um,10um 2>err >out.tab
is '0 1 1' "$? $(wc -l <err) $(grep -c '^xsect: host: radius 30 um, wavelength 0.55 um: far-field extinction .*beta = 6.85' err)" 'one warning, naming the worst row'
xsect --particle 1.5 --host 1.5+0.1i --size-parameter 0.01 2>err | tabtxt --columns q_ext,q_abs | sed 1d >back
is '1 1' "$(awk '$1 < 0 && $2 < 0' back | wc -l) $(grep -c '^xsect: host: x = 0.01: ' err)" 'and where extinction is negative'

# What is refused.
refused 'xsect: goa' '--host: .*absorbs; only Lorenz-Mie' xsect --method goa --particle 1.5 --host 1.33+0.01i --size-parameter 100
refused 'goa-phase' '--host: .*absorbs; only Lorenz-Mie' goa-phase --particle 1.5 --host 1.33+0.01i --size-parameter 100
refused 'a host that lets nothing through' '--host: 4 pi r Im.* is 456.959 at radius 20 um, .*at most 300' \
	xsect --particle 1.5 --host 1.33+1i --wavelength 550nm --radius 20um
refused 'by size parameter' '--host: .* at x = 400, .*at most 300' mie-phase --particle 1.5 --host 1+1i --size-parameter 400
refused 'particle like host' 'does not scatter' xsect --particle 1.33+0.01i --host 1.33+0.01i --size-parameter 1
mie-coeffs --particle 1.5 --host 1.33+0.01i --wavelength 550nm --radius 1um | tabtxt >c.txt
bad() { awk -v v="$1" 'BEGIN { OFS = FS = "\t" } NR > 1 { $4 = v } 1' c.txt | txttab >bad.tab; }
bad -0.01
refused 'coefficients: the other sign convention' 'row 1: host_im is negative' xsect bad.tab
bad 20
refused 'coefficients: a host that lets nothing through' 'row 1: 4 pi r host_im / wavelength is .*at most 300' mie-phase bad.tab
done_testing
