// Counts the fragments of a line: about 707 where lines have one per column, 1000 where they are rectangles of width 1
// (OpenGL 4.5, section 14.5; the latter under multisampling).
layout(std430) buffer LineRule { uint line_fragments; };
void main() { atomicAdd(line_fragments, 1u); }
