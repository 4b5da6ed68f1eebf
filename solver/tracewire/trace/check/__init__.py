"""Is the record fit to be traced, and the declared model fit to begin from?"""
