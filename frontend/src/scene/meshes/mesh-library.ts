import { SERVED, type MeshFiles } from "./mesh-files";
import type { MeshTemplate } from "./mesh-template";
import { SharedTextures } from "./shared-textures";

interface Shelf {
  /** What the server said identifies the file's content. */
  version: string | null;
  template: MeshTemplate;
}

/** Loads mesh files, each once as long as the file does not change. */
export class MeshLibrary {
  private readonly shelves = new Map<string, Shelf>();
  private readonly loading = new Map<string, Promise<MeshTemplate>>();

  readonly textures = new SharedTextures();

  constructor(readonly files: MeshFiles = SERVED) {}

  /**
   * The mesh at `url`. Asks the server every time whether the file is still the same: a robot is loaded anew when its
   * files were edited.
   *
   * @throws Error with a sentence for the user when the mesh cannot be drawn.
   */
  load(url: string, format: string): Promise<MeshTemplate> {
    let promise = this.loading.get(url);
    if (!promise) {
      promise = this.fetch(url, format.replace(/^\./, "").toLowerCase());
      this.loading.set(url, promise);
      const done = (): boolean => this.loading.delete(url);
      promise.then(done, done);
    }
    return promise;
  }

  private async fetch(url: string, format: string): Promise<MeshTemplate> {
    const response = await this.files.fetch(url);
    if (!response.ok) throw new Error(await refusal(response));
    const version = response.headers.get("ETag") ?? response.headers.get("Last-Modified");
    const shelf = this.shelves.get(url);
    if (shelf && version !== null && shelf.version === version) return shelf.template;
    const { readMesh } = await import("./formats");
    const template = await readMesh(await response.arrayBuffer(), format, new URL(url, document.baseURI).href, this.files);
    // What is still being drawn of the old one goes back to the GPU by itself.
    for (const part of shelf?.template.parts ?? []) part.geometry.dispose();
    this.shelves.set(url, { version, template });
    return template;
  }
}

/** The server explains a refusal in plain text; its first line will do. */
async function refusal(response: Response): Promise<string> {
  const plain = response.headers.get("Content-Type")?.startsWith("text/plain") ?? false;
  const [line = ""] = plain ? (await response.text()).trim().split("\n") : [];
  return line !== "" ? line : `the server answered ${response.status} ${response.statusText}`.trim();
}
