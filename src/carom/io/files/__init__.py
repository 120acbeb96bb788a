"""Results in standard files: one netCDF-4 (HDF5) file for each run, and conversion to xarray and pandas.

`layout` has the names and units of all variables in a file, `variables` makes them from a solution,
`scene_data` and `scene_parts` convert a scene to JSON and back, `raw` has the records of the loop, `checkpoint`
the state of the run; `writing` and `reading` write files and read them.
"""
