"""stub"""


def run() -> int:
    """Stub"""
    return 0
