#pragma once

#include "reconstruction/base/temporary_folder.h"
