"""The desktop window: Qt widgets that read a `ViewStatus` and emit commands, and carry out nothing."""
