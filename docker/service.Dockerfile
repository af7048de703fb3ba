# The solver service: numerics, store and web, no OpenGL and no Qt.
#
#     docker build -f docker/service.Dockerfile -t fev-service .
#     docker build -f docker/service.Dockerfile -t fev-service:cuda \
#         --build-arg BASE=nvidia/cuda:12.6.3-base-ubuntu24.04 .
#
# Any Debian or Ubuntu with Python 3.11 or newer can be BASE. Warp carries the CUDA runtime in its wheel: the GPU
# driver comes from the host, through the NVIDIA container toolkit.
ARG BASE=debian:bookworm-slim
FROM ${BASE}

ENV DEBIAN_FRONTEND=noninteractive \
    NVIDIA_DRIVER_CAPABILITIES=compute,utility \
    NVIDIA_VISIBLE_DEVICES=all \
    PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1

# Python alone is named here; what FEV itself needs of the system is listed once, in `fev`.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends python3 python3-venv \
    && rm -rf /var/lib/apt/lists/*

WORKDIR /opt/fev
COPY fev ./
RUN python3 fev libraries solve && rm -rf .cache /var/lib/apt/lists/*

COPY .ci/requirements.lock .ci/
COPY LICENSE README.md pyproject.toml ./
COPY protocol protocol
COPY solver_service solver_service
# Versions come from the lock (-c), so nothing is unpinned here.
# hadolint ignore=DL3013,DL3042
RUN python3 -m venv .venv \
    && .venv/bin/pip install -c .ci/requirements.lock setuptools \
    && .venv/bin/pip install -c .ci/requirements.lock --no-build-isolation ".[solver]"

RUN useradd --create-home --uid 10001 fev && install -d -o fev -g fev /data
USER 10001
ENV PATH=/opt/fev/.venv/bin:$PATH
# Compile the CPU kernels now, so that the first run starts at once; CUDA kernels wait for the GPU they are for.
RUN fev-solver warmup --device cpu

VOLUME /data
EXPOSE 8765
HEALTHCHECK --interval=15s --timeout=5s --start-period=60s --retries=3 \
    CMD ["python", "-c", "import urllib.request as r; r.urlopen('http://127.0.0.1:8765/healthz', timeout=4)"]
ENTRYPOINT ["fev-solver"]
CMD ["serve", "--host", "0.0.0.0", "--port", "8765", "--data-dir", "/data", "--token-file", "/run/secrets/fev_token"]
