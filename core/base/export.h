// Defines the mark for what liblimn exports to techniques and applications; everything else is hidden.
#pragma once

#define LIMN_API __attribute__((visibility("default")))
