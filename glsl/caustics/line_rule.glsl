// How the driver rasterises lines, as the pass "line rule" counted it: which weights its fragments need.
#ifndef LIMN_LINE_RULE_GLSL
#define LIMN_LINE_RULE_GLSL

layout(std430) readonly buffer LineRule { uint line_fragments; };  // of a diagonal line of 1000 pixels (line_rule.frag.glsl)

// Whether lines are rectangles of one pixel's width; else they have one fragment in each column (or row).
bool lines_are_rectangles() { return line_fragments > 850u; }

#endif  // LIMN_LINE_RULE_GLSL
