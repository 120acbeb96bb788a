"""Positions and motion of points, joints and coordinates; free flight in closed form."""
