/* limits - how much a reader takes from a file before it refuses: files come from other people, and a header of a few bytes must
 * not cost memory or time out of proportion to its file. Each with its reason; a reader dies beyond, and says what is too large.
 *
 * What a command line may say is in the tools' tables of options (base/opt.h), what a scene may in render/scene_file.c, and
 * what is in reach of a theory in toolkit/size.h. */
#ifndef FORMAT_LIMITS_H
#define FORMAT_LIMITS_H

#include <stddef.h>
#include <stdint.h>

/* Tables, tab(5). */
#define TAB_COLS 64                     /* columns: rows lie on the stack */
#define TAB_NAME 32                     /* bytes of a column's name or unit, with the final 0 */
#define TAB_HEADER_MAX (1u << 20)       /* bytes of a header: it is held whole */
#define HISTORY_LINES 4096              /* commands in the history of a table, medium or image: joining two looks for each in the other */
#define TAB_BLOCK_MAX (1u << 20)        /* bytes of a block of rows: it is held whole, and checked before its rows are used */

/* OpenEXR images. */
#define EXR_CHANNELS 2048               /* each has room in struct exr; a spectral part has six a wavelength */
#define EXR_NAME 64                     /* bytes of a channel's name, with the final 0 */
#define EXR_SIDE_MAX 32768              /* pixels along a side: bytes of a line fit an int at any number of channels */
#define EXR_TILE_MAX 4096               /* pixels along a tile's side */
#define EXR_FILE_MAX ((size_t)16 << 30) /* bytes: a file is held whole, for standard input cannot seek */
#define EXR_PACKING_MAX 4096            /* no compression packs tighter: a header that promises more pixels is damaged */

/* NumPy arrays. */
#define NPY_HEADER_MAX 65536            /* bytes of a header: what version 1.0 of the format can have */
#define NPY_VOXELS_MAX ((size_t)1 << 36)    /* sums and products of sizes do not overflow */

/* Media, medium(5). Beside these, all sections' indices fit an int32: the kernels count by it. */
#define MEDIUM_HEADER_MAX (1u << 20)    /* bytes of a header: a history is copied for each line */
#define MEDIUM_CLASSES 4096             /* classes: reading them is quadratic, and so is a mixture's grid */
#define MEDIUM_WAVES 1024               /* wavelengths */
#define MEDIUM_VOXELS_SIDE 4096         /* voxels along a side */
#define MEDIUM_CELLS_SIDE (1 << 24)     /* cells of the particles' grid along a side: floats count them exactly */
#define MEDIUM_PARTICLES_MOST (INT32_MAX / 4)     /* particles, of four floats */
#define MEDIUM_REACH 1e9                /* m: half sides and positions are below */
#define MEDIUM_VALUE 1e30               /* counts, cross sections, densities and extinctions are below: floats hold their products */
#define MEDIUM_DISC_LEAST 1e-25         /* um^2: the largest particle is no smaller, so that its disc in m^2 is a normal float */
#define MEDIUM_INTERVAL 0.01746f        /* rad, between two angles of a phase function: 1 degree, and a rounding */
#define PHASE_ANGLES_MAX (1 << 24)      /* of one phase function in a table: positions among them fit a float and an int */

#endif
