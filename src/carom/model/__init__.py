"""The scene compiled into arrays, which a run reads, and the records and workspace that it writes."""
