"""Where points, joints and coordinates are and how they move; free flight in closed form."""
