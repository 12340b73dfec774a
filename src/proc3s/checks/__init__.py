"""What makes a domain a sound one, check by check: behind `proc3s check` and `proc3s.testing`."""
