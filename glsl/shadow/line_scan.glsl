// Running sums along the lines of a map, its rows (VERTICAL 0) or its columns (VERTICAL 1). SHARED 0: a thread follows a whole
// line (quickest where threads are few, on software renderers). SHARED 1: LENGTH threads of a work group follow a line, LINES
// lines at a time, and scan_line() adds up what each of them has. How many lines a group takes is known to lineGroups() in
// core/shadow/summed_area_passes.cpp, too.
//
// Define SUM_TYPE, a vector of integers, and SUM(a, b), which must be the same in any order.
#ifndef LIMN_LINE_SCAN_GLSL
#define LIMN_LINE_SCAN_GLSL

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

#include "glsl/numeric/group_scan.glsl"
#else
layout(local_size_x = 16) in;
#endif

#endif  // LIMN_LINE_SCAN_GLSL
