#!/usr/bin/env python3
"""unpack_image.py IMAGE ROOT: an OCI image (an archive of its layout) as a runtime takes it: every
blob by its digest and size, the layers in order into ROOT. Prints the command that it starts, one
word a line."""
import hashlib
import io
import json
import sys
import tarfile
import zlib


def blob(image, descriptor):
    algorithm, digest = descriptor["digest"].split(":")
    content = image.extractfile(f"blobs/{algorithm}/{digest}").read()
    if hashlib.new(algorithm, content).hexdigest() != digest or len(content) != descriptor["size"]:
        sys.exit(f"{descriptor['digest']}: another content")
    return content


def main(path, root):
    with tarfile.open(path) as image:
        layout = json.load(image.extractfile("oci-layout"))
        if layout["imageLayoutVersion"] != "1.0.0":
            sys.exit("not a layout of version 1.0.0")
        manifest = json.loads(blob(image, json.load(image.extractfile("index.json"))["manifests"][0]))
        config = json.loads(blob(image, manifest["config"]))
        for layer, wanted in zip(manifest["layers"], config["rootfs"]["diff_ids"], strict=True):
            content = zlib.decompress(blob(image, layer), 31)
            if "sha256:" + hashlib.sha256(content).hexdigest() != wanted:
                sys.exit(f"{layer['digest']}: not the layer {wanted}")
            with tarfile.open(fileobj=io.BytesIO(content)) as files:
                files.extractall(root)
    print("\n".join(config["config"]["Entrypoint"] + config["config"]["Cmd"]))


main(*sys.argv[1:])
