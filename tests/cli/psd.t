#!/bin/sh
# psd: the table it writes, and what it refuses. The classes themselves are checked by psd_moments.c.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# Numbers are cut to ten digits: the last ones are the mathematical library's.
table() { "$@" | tabtxt | awk -F'\t' 'NR == 1 { print; next } { for (i = 1; i <= NF; i++) printf("%s%.10g", i > 1 ? "\t" : "", $i); print "" }'; }

{
	table psd mono --radius 550nm
	table psd lognormal --median 10um --gsd 1.3
	table psd lognormal --median 10um --gsd 1.3 --classes 1
	table psd gamma --effective-radius 10um --effective-variance 0.1 --classes 5
	table psd normal --mean 10um --stddev 2um --classes 2
	table psd uniform --min 1um --max 2um --classes 3
	table psd power --exponent 4 --min 100nm --max 10um --classes 4
} >"$tmp/all"
golden psd.txt "$tmp/all"

# Gauss and Legendre's rule of three points on [1, 2], in the roots of P3 and the weights 5/18, 8/18.
is '1.112701665 0.2777777778
1.5 0.4444444444
1.887298335 0.2777777778' "$(table psd uniform --min 1um --max 2um --classes 3 | sed 1d | cut -f 1,2 | tr '\t' ' ')" 'uniform: three points'

is '10 1 10 10' "$(psd mono --radius 10um --classes 40 | tabtxt | sed 1d | tr '\t' ' ')" 'mono has one class, whatever --classes says'
is 1000 "$(psd lognormal --median 1um --gsd 3 --classes 1000 | tabtxt | sed 1d | wc -l)" 'as many rows as classes'
psd lognormal --median 10um --gsd 1.3 -o "$tmp/a.tab" --min 2um
is 'psd lognormal --median 10um --gsd 1.3 --min 2um' "$(sed -n 's/^cmd	//p' "$tmp/a.tab")" 'the history has the command, without -o'
psd --min 2000nm lognormal --gsd 1.3 --median 0.01mm | tabtxt >"$tmp/b"
tabtxt "$tmp/a.tab" | cmp -s - "$tmp/b"
ok $? 'units and order of the options do not matter'
is 2 "$(tabtxt "$tmp/a.tab" | sed -n '2s/.*	\(.*\)	.*/\1/p')" 'the first class begins at --min'

refused 'no distribution' '^psd: name a distribution' psd
refused 'an unknown one' '^psd: weibull: is no distribution' psd weibull
refused 'two' '^psd: gamma: one distribution' psd mono gamma --radius 1um
refused 'a length without a unit' "^psd: --radius: '10' is a length without a unit \(write it like 10um" psd mono --radius 10
refused 'a length that is NaN' "^psd: --radius: 'nan' is not a length" psd mono --radius nan
refused 'a radius of 0' '^psd: --radius: .* out of range' psd mono --radius 0um
refused 'a negative radius' '^psd: --median: .* out of range' psd lognormal --median -1um --gsd 2
refused 'mono without a radius' '^psd: --radius: mono needs it' psd mono
refused 'mono with --min' '^psd: --min: does not belong to mono' psd mono --radius 1um --min 1um
refused 'lognormal without --gsd' '^psd: --gsd: lognormal needs it' psd lognormal --median 1um
refused 'gamma with --gsd' '^psd: --gsd: does not belong to gamma' psd gamma --gsd 2 --effective-radius 1um --effective-variance 0.1
refused 'uniform without --max' '^psd: --max: uniform needs it' psd uniform --min 1um
refused 'uniform with --mean' '^psd: --mean: does not belong to uniform' psd uniform --min 1um --max 2um --mean 1um
refused 'a gsd of 1' '^psd: lognormal: needs a geometric standard deviation greater than 1' psd lognormal --median 1um --gsd 1
refused 'an effective variance of 0.5' '^psd: gamma: needs an effective variance' psd gamma --effective-radius 1um --effective-variance 0.5
refused 'a gamma distribution that is all small particles' '^psd: gamma: reaches below 1e-9um' psd gamma --effective-radius 1um --effective-variance 0.49
refused 'a standard deviation of 0' '^psd: normal: needs a standard deviation' psd normal --mean 1um --stddev 0um
refused 'an exponent that is no number' "^psd: --exponent: 'inf' is not a number" psd power --exponent inf --min 1um --max 2um
refused 'limits exchanged' '^psd: power: has its smallest radius not below its largest' psd power --exponent 2 --min 2um --max 1um
refused 'a smallest radius beyond the default largest' '^psd: lognormal: .* give its largest' psd lognormal --median 1um --gsd 1.1 --min 5um
refused 'a largest radius below the default smallest' '^psd: lognormal: .* give its smallest' psd lognormal --median 1um --gsd 1.1 --max 100nm
refused 'limits where there is nothing' '^psd: lognormal: has no particles' psd lognormal --median 1um --gsd 1.01 --min 1mm --max 2mm
refused 'no classes' '^psd: --classes: .* out of range' psd lognormal --median 1um --gsd 2 --classes 0
refused 'half a class' "^psd: --classes: '1.5' is not a whole number" psd lognormal --median 1um --gsd 2 --classes 1.5
refused 'classes too narrow to tell apart' '^psd: uniform: has so many classes' psd uniform --min 1um --max 1.0001um --classes 100000
refused 'an unknown option' '^psd: --preset: unknown option' psd mono --radius 1um --preset fog

psd lognormal --median 1um --gsd 1 -o "$tmp/none.tab" 2>/dev/null
ok "$([ $? -eq 2 ] && [ ! -e "$tmp/none.tab" ]; echo $?)" 'a failed run leaves no file'
psd --help | grep -q -e '--effective-radius R'
ok $? '--help'
done_testing
