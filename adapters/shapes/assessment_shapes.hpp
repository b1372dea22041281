/// Results of assessments whose fields more than one document has.
#pragma once

#include "adapters/shapes/shape.hpp"
#include "core/assessment/output_assessment.hpp"

SHAPE(recald::assessment::MonthForecast, mean, q05, q50, q95);
