"""One HTML file that tells of a design, or of a sweep: opened by itself, it asks nothing of any server."""
