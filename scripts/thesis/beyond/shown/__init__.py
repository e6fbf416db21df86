"""The experiments beyond the thesis's on their page: figure, sentence and words of each."""
