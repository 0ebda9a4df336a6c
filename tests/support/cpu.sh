# shellcheck shell=sh
# cpus: the levels of MOTES_CPU that there are builds for and that this processor has, narrowest first; with the tools on the PATH.
cpus() {
	for level in scalar v2 v3 v4; do
		if MOTES_CPU=$level goa-phase --particle 1.33 --size-parameter 20 --theta 0 >/dev/null 2>&1; then echo $level; fi
	done
}
