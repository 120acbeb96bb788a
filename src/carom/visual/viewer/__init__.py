"""`carom.view`: show a run live in a browser, or as an HTML page."""
