import type { LoadReport, MeshProgress } from "../../state/mesh-progress";
import { strings } from "../../strings";
import { formatBytes, MeshError } from "./mesh-error";
import { SERVER_FILES, type MeshFiles } from "./mesh-files";
import type { MeshTemplate } from "./mesh-template";
import type { LodMeshes } from "./lod-meshes";
import { SharedTextures } from "./shared-textures";

/** The maximum size of a file: browsers do not support longer strings, and no GPU draws so many triangles. */
const MAX_BYTES = 500_000_000;

interface CachedMesh {
  /** The file's ETag or date of modification. */
  version: string | null;
  template: MeshTemplate;
}

/** Loads mesh files, each only once while it does not change. */
export class MeshLibrary {
  private readonly cache = new Map<string, CachedMesh>();
  private readonly templates = new Map<string, Promise<MeshTemplate>>();

  readonly textures = new SharedTextures();

  constructor(
    private readonly progress: MeshProgress,
    readonly files: MeshFiles = SERVER_FILES,
    /** Simplified versions of meshes for motion; null for none. */
    readonly lodMeshes: LodMeshes | null = null,
  ) {}

  /**
   * Loads the mesh at `url`. Each call checks whether the file has changed, because a robot is loaded again after its
   * files were edited.
   *
   * @throws MeshError with a clause for the user if the mesh cannot be drawn.
   */
  load(url: string, format: string): Promise<MeshTemplate> {
    let promise = this.templates.get(url);
    if (!promise) {
      const report = this.progress.startLoad(fileNameOf(url));
      promise = this.fetch(url, format.replace(/^\./, "").toLowerCase(), report);
      this.templates.set(url, promise);
      const finish = (): void => {
        report.end();
        this.templates.delete(url);
      };
      promise.then(finish, finish);
    }
    return promise;
  }

  private async fetch(url: string, format: string, report: LoadReport): Promise<MeshTemplate> {
    const response = await awaitData(this.files.fetch(url));
    if (!response.ok) throw new MeshError(await readRefusal(response));
    const version = response.headers.get("ETag") ?? response.headers.get("Last-Modified");
    const cachedMesh = this.cache.get(url);
    if (cachedMesh && version !== null && cachedMesh.version === version) {
      void response.body?.cancel();
      return cachedMesh.template;
    }
    const data = await readBytes(response, report);
    const { readMesh } = await import("./formats");
    await report.startReading();
    const template = await readMesh(data, format, new URL(url, document.baseURI).href, this.files);
    // three.js uploads an old geometry that is still being drawn again.
    for (const part of cachedMesh?.template.parts ?? []) part.geometry.dispose();
    this.cache.set(url, { version, template });
    return template;
  }
}

/** Waits for data from the server; a lost connection becomes a MeshError. */
async function awaitData<T>(data: Promise<T>): Promise<T> {
  return data.catch(() => {
    throw new MeshError(strings.meshes.lost);
  });
}

async function readBytes(response: Response, report: LoadReport): Promise<ArrayBuffer> {
  const { headers } = response;
  const statedLength = Number(headers.get(headers.has("Content-Encoding") ? "X-Unpacked-Length" : "Content-Length") ?? NaN);
  const totalBytes = Number.isFinite(statedLength) ? statedLength : null;
  if (totalBytes !== null) checkSize(totalBytes);
  const reader = response.body?.getReader();
  if (!reader) return awaitData(response.arrayBuffer());
  const chunks: Uint8Array[] = [];
  let bytes = 0;
  for (let chunk = await awaitData(reader.read()); !chunk.done; chunk = await awaitData(reader.read())) {
    chunks.push(chunk.value);
    bytes += chunk.value.length;
    checkSize(bytes);
    report.onBytes(bytes, totalBytes);
  }
  const content = new Uint8Array(bytes);
  let position = 0;
  for (const chunk of chunks) {
    content.set(chunk, position);
    position += chunk.length;
  }
  return content.buffer;
}

function checkSize(bytes: number): void {
  if (bytes > MAX_BYTES) throw new MeshError(strings.meshes.tooLarge(formatBytes(bytes), formatBytes(MAX_BYTES)));
}

/** Returns the reason for a refusal: the first line of the server's plain text. */
async function readRefusal(response: Response): Promise<string> {
  if (response.status === 404) return strings.meshes.gone;
  const isPlainText = response.headers.get("Content-Type")?.startsWith("text/plain") ?? false;
  const [line = ""] = isPlainText ? (await awaitData(response.text())).trim().split("\n") : [];
  return line !== "" ? line : strings.meshes.answered(`${response.status} ${response.statusText}`.trim());
}

function fileNameOf(url: string): string {
  const [path = ""] = url.split("?");
  const name = path.slice(path.lastIndexOf("/") + 1);
  try {
    return decodeURIComponent(name);
  } catch {
    return name;
  }
}
