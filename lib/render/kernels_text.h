/* kernels_text - the text of lib/render/kern, as generated for the OpenCL compiler. */
#ifndef RENDER_KERNELS_TEXT_H
#define RENDER_KERNELS_TEXT_H

extern const char kernels_source[];

#endif
