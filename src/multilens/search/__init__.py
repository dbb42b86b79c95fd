"""From a question to a design: starts, descent, polish, proof; one idea a file."""
