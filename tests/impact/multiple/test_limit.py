"""An impact is broken off where it takes more steps than a run can afford."""

import numpy as np
import pytest

from carom.impact.multiple.api import multiple_settings
from carom.impact.multiple.layout import UNLIMITED, new_multiple_result, new_multiple_workspace
