# Tables of refractive indices to C: materials[] of ior.h.
# usage: awk -f materials.awk NAME.tsv ..
# A table has the columns wavelength (um, ascending), n, k; comment lines begin with #, one of them is "# Source: ...".

function stop(what)
{
	print FILENAME ":" FNR ": " what >"/dev/stderr"
	failed = 1
	exit 1
}

FNR == 1 {
	name[++count] = tolower(FILENAME)
	sub(".*/", "", name[count])
	sub("\\.tsv$", "", name[count])
	lines[count] = 0
}

/^# Source: / {
	source[count] = substr($0, 11)
	gsub(/["\\]/, "\\\\&", source[count])
}

/^#/ || NF == 0 { next }

{
	for (i = 1; i <= NF; i++)
		if ($i !~ /^[0-9]+(\.[0-9]*)?([eE][-+]?[0-9]+)?$/)
			stop("'" $i "' is not a number")
	if (NF != 3 || $1 <= 0 || $2 <= 0)
		stop("wanted: wavelength > 0, n > 0, k >= 0")
	if (lines[count] && $1 + 0 <= last + 0)
		stop("wavelengths do not ascend")
	if (!lines[count])
		first[count] = $1
	last = final[count] = $1
	l = ++lines[count]
	w[count, l] = $1
	n[count, l] = $2
	k[count, l] = $3
}

function column(c, array, i)
{
	printf "\t(const double[]){"
	for (i = 1; i <= lines[c]; i++)
		printf "%s%s", i % 8 == 1 ? "\n\t\t" : " ", array[c, i] ","
	print "\n\t},"
}

END {
	if (failed)
		exit 1
	print "/* Written by lib/optics/index/materials.awk from data/materials. */"
	print "#include \"optics/index/ior.h\"\n"
	print "const struct material materials[] = {"
	for (c = 1; c <= count; c++) {
		if (lines[c] < 2 || source[c] == "") {
			print name[c] ": no source or fewer than two rows" >"/dev/stderr"
			exit 1
		}
		printf "{\n\t\"%s\",\n\t\"%s\",\n", name[c], source[c]
		printf "\t\"is outside the data of %s, %sum to %sum\",\n\t%d,\n", name[c], first[c], final[c], lines[c]
		column(c, w)
		column(c, n)
		column(c, k)
		print "},"
		names = names (c > 1 ? ", " : "") name[c]
	}
	print "};\n\nconst size_t n_materials = sizeof materials / sizeof *materials;\n"
	print "const char materials_unknown[] ="
	print "\t\"is neither a number like 1.33 or 1.5+0.1i nor a known material (" names ")\";"
}
