"""The verification book: every case through the command line, compared with an exact or independent reference."""
