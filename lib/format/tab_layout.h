/* tab_layout - what the reader and the writer of tab(5) have to agree on. */
#ifndef FORMAT_TAB_LAYOUT_H
#define FORMAT_TAB_LAYOUT_H

#define TAB_MAGIC "#?MOTES-TAB 1\n"
#define TAB_END_SIZE 16      /* of the end mark: u32 0, u64 rows, u32 CRC-32 of all before */

#endif
