"""Pictures of a run: plots, films, the HTML page and the live view."""
