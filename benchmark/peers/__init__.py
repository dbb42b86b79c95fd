"""What a designer would use instead of multilens: general optimisers, each with its best settings of those tried."""
