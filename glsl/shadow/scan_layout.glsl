// Which thread scans what: a line each (SHARED 0), or a work group of LENGTH threads a line, LINES lines at a time (SHARED 1),
// along the rows (VERTICAL 0) or the columns (VERTICAL 1) of a map.
#ifndef LIMN_SCAN_LAYOUT_GLSL
#define LIMN_SCAN_LAYOUT_GLSL

#if SHARED
#if VERTICAL
#define LINES 16  // neighbouring columns, so that neighbouring threads meet neighbouring texels
#define LENGTH 16
layout(local_size_x = LINES, local_size_y = LENGTH) in;
#define LOCAL_LINE int(gl_LocalInvocationID.x)
#define LOCAL_POSITION int(gl_LocalInvocationID.y)
#else
#define LINES 4
#define LENGTH 64
layout(local_size_x = LENGTH, local_size_y = LINES) in;
#define LOCAL_LINE int(gl_LocalInvocationID.y)
#define LOCAL_POSITION int(gl_LocalInvocationID.x)
#endif
#else
layout(local_size_x = 16) in;
#endif

#endif
