// Part of the public interface, where it lives; here so that the rooms name it like everything else of base.
#pragma once

#include "lumirank/sinks.h"
