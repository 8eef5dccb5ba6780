# An image with Lockstep installed:
#   docker build -t lockstep .
#   docker run -v "$PWD:/data" lockstep simulate /usr/share/lockstep/xml-params/scenes/constraints-2d.xml --output /data/run
FROM debian:12 AS build
COPY . /lockstep
RUN /lockstep/tools/make-package

FROM debian:12
COPY --from=build /lockstep/build/package/lockstep_*.deb /packages/
RUN apt-get update && apt-get install -y --no-install-recommends /packages/lockstep_*.deb && rm -rf /packages /var/lib/apt/lists/*
ENV PATH=/usr/share/lockstep/tools:$PATH OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMP_NUM_THREADS=1
WORKDIR /data
