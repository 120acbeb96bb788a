"""The scene compiled into arrays (what a run reads), and the records and workspace that a run writes."""
