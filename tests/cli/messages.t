#!/bin/sh
# What is said of inputs that are likely to be meant otherwise.
# shellcheck source=tests/support/lib.sh
. "$(dirname "$0")/../support/lib.sh"

# Equal angles too few for the forward peak: said once, with what p then integrates to, and what helps.
one() { mie-phase --particle 1.33 --wavelength 550nm --radius 50um "$@"; }
bake() { printf '# radius:f64:um\tweight:f64:1\n50\t1\n' | txttab | medium-bake --xsect one.xsect --psd - --concentration 1e6/m3 --box 1m,1m,1m -o m "$@"; }
xsect --particle 1.33 --wavelength 550nm --radius 50um -o one.xsect
one --angles 181 -o coarse.tab 2>err
is '0 1' "$? $(grep -c '^mie-phase: --angles: 181 are too few for the forward peak of x = 571.2: .* about 4.66, not 1; take 2602 or more' err)" \
	'angles too few for the forward peak'
is 1 "$(wc -l <err)" 'are told in one line'
bake --phase coarse.tab 2>err
is '2 1' "$? $(grep -c 'is 4.67.., more than 1 % off 1: its angles are too few for its peaks (leave out --angles' err)" \
	'what refuses the table names the remedy; the integral was foretold'
one --angles 2602 -o fine.tab 2>err && bake --phase fine.tab 2>>err
is '0 ' "$? $(cat err)" 'as many as were asked for are taken, without a word'
one --angles 2601 -o near.tab 2>err
is 1 "$(wc -l <err)" 'one less is too few: 4.553 x + 1'
one -o own.tab 2>err && one --theta 0:180:1 -o some.tab 2>>err
is '' "$(cat err)" 'angles of their own are not too few, and given ones are what was asked for'
goa-phase --particle 1.33 --wavelength 550nm --radius 50um,1um --angles 181 -o goa.tab 2>err
is 1 "$(grep -c '^goa-phase: --angles: 181 are too few for the forward peak of x = 571.2:' err)" 'goa-phase: the largest counts'
# A mean: weighted as what is scattered, a few large ones do not count.
printf '# radius:f64:um\tweight:f64:1\n1\t1\n50\t1e-9\n' | txttab >few.tab
printf '# radius:f64:um\tweight:f64:1\n1\t1\n50\t1e-2\n' | txttab >many.tab
mean() { mie-phase --particle 1.33 --wavelength 550nm --average --angles 1001 "$1" -o mean.tab 2>err; wc -l <err; }
is '0 1' "$(mean few.tab) $(mean many.tab)" 'in a mean'
done_testing
