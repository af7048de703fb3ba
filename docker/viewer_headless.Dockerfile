# The viewer without a screen: pictures of a running service, drawn by Mesa's software rasteriser through EGL.
#
#     docker build -f docker/viewer_headless.Dockerfile -t fev-viewer-headless .
ARG BASE=debian:bookworm-slim
FROM ${BASE}

ENV DEBIAN_FRONTEND=noninteractive \
    PIP_DISABLE_PIP_VERSION_CHECK=1 \
    PIP_NO_CACHE_DIR=1

# Python alone is named here; what FEV itself needs of the system is listed once, in `fev`.
# hadolint ignore=DL3008
RUN apt-get update \
    && apt-get install -y --no-install-recommends python3 python3-venv \
    && rm -rf /var/lib/apt/lists/*

WORKDIR /opt/fev
COPY fev ./
RUN python3 fev libraries draw && rm -rf .cache /var/lib/apt/lists/*

COPY .ci/requirements.lock .ci/
COPY LICENSE README.md pyproject.toml ./
COPY protocol protocol
COPY viewer viewer
# Versions come from the lock (-c), so nothing is unpinned here.
# hadolint ignore=DL3013,DL3042
RUN python3 -m venv .venv \
    && .venv/bin/pip install -c .ci/requirements.lock setuptools \
    && .venv/bin/pip install -c .ci/requirements.lock --no-build-isolation ".[viewer]"

RUN useradd --create-home --uid 10001 fev && install -d -o fev -g fev /pictures
USER 10001
ENV PATH=/opt/fev/.venv/bin:$PATH

VOLUME /pictures
ENTRYPOINT ["fev-viewer"]
CMD ["--help"]
