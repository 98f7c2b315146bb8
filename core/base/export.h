// Marks what liblimn shows to techniques and applications; everything else is hidden.
#pragma once

#define LIMN_API __attribute__((visibility("default")))
