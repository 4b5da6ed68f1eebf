"""The choice between finalists by what they predict, the verdict, and what it must withstand."""
