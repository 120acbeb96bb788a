"""Results in standard files: one netCDF-4 (HDF5) file a run, and conversion to xarray and pandas.

`layout` says what there is in a file and what it is called, `variables` makes it from a solution, `scene_data`
and `scene_parts` turn a scene into JSON and back, `raw` keeps what the loop has written, `checkpoint` where it
stands; `writing` and `reading` are the way to the disk and back.
"""
