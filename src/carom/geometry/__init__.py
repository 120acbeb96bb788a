"""Pure mathematics: rotations, autoparallels, transport, connection, splines."""
