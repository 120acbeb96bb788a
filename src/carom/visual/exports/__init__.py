"""A run for other programs: glTF, VTK, USD; needs ``carom[export]``."""

from carom.visual.exports.api import export as export
