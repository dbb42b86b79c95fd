"""Pictures of a design: the only home of matplotlib. Nothing is shown, nothing global is kept; figures are given back."""
