"""The wiring: one state machine that the window and the headless flight drive alike."""
