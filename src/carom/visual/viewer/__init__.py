"""Looking at a run: `carom.view`, live in a browser or as a page that plays by itself."""
