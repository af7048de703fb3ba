"""Cases from outside: received within limits, imported by a confined process, kept in the data folder."""
