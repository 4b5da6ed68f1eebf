"""The choice between finalists by what they predict, and the verdict."""
