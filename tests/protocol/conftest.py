"""Property tests: no deadline, since another process may hold the processor."""

from hypothesis import HealthCheck, settings

settings.register_profile("fev", deadline=None, suppress_health_check=[HealthCheck.too_slow])
settings.load_profile("fev")
