#include "measurement/report/report.h"
