# The program in a small image, for one machine or for many (docs/deploy.md). Build: docker build -t rubmap . Run, for this machine alone:
# docker run -p 127.0.0.1:8080:8080 -e RUBMAP_OPEN=true -v rubmap:/data rubmap

FROM rust:1.95-slim-trixie AS build
WORKDIR /src
# Dependencies first: they change less often than we do.
COPY Cargo.toml Cargo.lock build.rs ./
COPY crates/analysis/Cargo.toml crates/analysis/
COPY crates/fit/Cargo.toml crates/fit/
COPY crates/mesh/Cargo.toml crates/mesh/
COPY crates/model/Cargo.toml crates/model/
COPY crates/numerics/Cargo.toml crates/numerics/
COPY crates/plot/Cargo.toml crates/plot/
COPY crates/script/Cargo.toml crates/script/build.rs crates/script/
COPY crates/solid/Cargo.toml crates/solid/
COPY crates/validation/Cargo.toml crates/validation/
COPY crates/wheel/Cargo.toml crates/wheel/
COPY fuzz/Cargo.toml fuzz/
RUN mkdir src && echo 'fn main() {}' > src/main.rs && touch src/lib.rs \
    && for crate in crates/*; do mkdir "$crate/src" && touch "$crate/src/lib.rs"; done \
    && sed -i '/^\[\[bench\]\]/,$d' Cargo.toml \
    && cargo build --release --locked --features cluster && rm -r src crates
COPY . .
# The image is built without the history: `--build-arg RUBMAP_COMMIT=$(git rev-parse HEAD)` tells what it is built from.
ARG RUBMAP_COMMIT
# Files copied keep their times; the program must look newer than its stand-in.
RUN touch build.rs src/main.rs src/lib.rs crates/*/src/lib.rs \
    && cargo build --release --locked --features cluster

FROM debian:trixie-slim
# Whom to trust when PostgreSQL and S3 are reached over TLS.
RUN apt-get update && apt-get install --yes --no-install-recommends ca-certificates && rm -rf /var/lib/apt/lists/*
COPY --from=build /src/target/release/rubmap /usr/local/bin/rubmap
RUN useradd --system --uid 10001 --home-dir /data rubmap && install -d -o rubmap -g rubmap /data
USER rubmap
VOLUME /data
EXPOSE 8080
# Whoever reaches the port may use the service only with -e RUBMAP_TOKENS=FILE (docs/operations.md), or with -e RUBMAP_OPEN=true.
ENV RUBMAP_ADDR=0.0.0.0:8080 RUBMAP_DATA=/data
# A worker answers, too. The slim image has no curl, but its bash speaks TCP.
HEALTHCHECK --interval=30s --timeout=5s --start-period=10s CMD ["bash", "-c", \
    "exec 3<>/dev/tcp/127.0.0.1/8080 && printf 'GET /readyz HTTP/1.0\\r\\n\\r\\n' >&3 && grep -q '200 OK' <&3"]
ENTRYPOINT ["rubmap"]
CMD ["serve"]
