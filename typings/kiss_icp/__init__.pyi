# What the project names of KISS-ICP, an optional package that may not be installed.
