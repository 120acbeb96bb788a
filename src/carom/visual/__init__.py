"""Pictures: plots, films, the page of a run and the live view."""
