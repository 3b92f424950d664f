import type { MeshFiles } from "../scene/meshes/mesh-files";
import { decodeBase64 } from "./recording";

const IMAGE_TYPES: Readonly<Record<string, string>> = {
  png: "image/png",
  jpg: "image/jpeg",
  jpeg: "image/jpeg",
  bmp: "image/bmp",
  gif: "image/gif",
  webp: "image/webp",
};

/** The meshes and textures that are embedded in the page. */
export class RecordedFiles implements MeshFiles {
  private readonly blobUrls = new Map<string, string>();

  constructor(private readonly files: Readonly<Record<string, string>>) {}

  fetch(url: string): Promise<Response> {
    const path = meshPathOf(url);
    const file = this.files[path];
    if (file === undefined) return Promise.resolve(new Response("no such file", { status: 404 }));
    return Promise.resolve(new Response(decodeBase64(file), { headers: { ETag: path } }));
  }

  addressOf(url: string): string {
    const path = meshPathOf(url);
    const file = this.files[path];
    if (file === undefined) return url;
    let blobUrl = this.blobUrls.get(path);
    if (blobUrl === undefined) {
      const type = IMAGE_TYPES[path.slice(path.lastIndexOf(".") + 1).toLowerCase()] ?? "application/octet-stream";
      blobUrl = URL.createObjectURL(new Blob([decodeBase64(file)], { type }));
      this.blobUrls.set(path, blobUrl);
    }
    return blobUrl;
  }
}

/** Returns the `/mesh/...` part of an address, which does not depend on where the page was opened. */
function meshPathOf(url: string): string {
  const [path = ""] = url.split("?");
  const index = path.indexOf("/mesh/");
  return index < 0 ? path : path.slice(index);
}
