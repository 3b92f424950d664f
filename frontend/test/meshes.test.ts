import type { BufferGeometry } from "three";
import { afterEach, beforeEach, describe, expect, it, vi } from "vitest";
import { formatProgress } from "../src/panels/over-scene/mesh-notice";
import { fixXml } from "../src/scene/meshes/collada";
import { readMesh } from "../src/scene/meshes/formats";
import type { MeshFiles } from "../src/scene/meshes/mesh-files";
import { MeshLibrary } from "../src/scene/meshes/mesh-library";
import { collapseNonFinite } from "../src/scene/meshes/non-finite";
import type { MeshTemplate } from "../src/scene/meshes/mesh-template";
import { MeshProgress } from "../src/state/mesh-progress";

vi.mock("../src/strings", async () => ({ strings: (await import("../src/strings/en")).en }));

const NO_FILES: MeshFiles = {
  fetch: () => Promise.resolve(new Response("no such file", { status: 404 })),
  addressOf: (url) => url,
};

function encode(text: string): ArrayBuffer {
  return new TextEncoder().encode(text).buffer;
}

function readData(format: string, data: string | ArrayBuffer): Promise<MeshTemplate> {
  return readMesh(typeof data === "string" ? encode(data) : data, format, "http://page/mesh/a", NO_FILES);
}

async function readError(format: string, data: string | ArrayBuffer): Promise<string> {
  return readData(format, data).then(
    () => "",
    (reason: unknown) => (reason instanceof Error ? reason.message : "?"),
  );
}

/** Returns a binary STL that has `triangles` and declares `declared`; the first coordinate of each triangle is `value`. */
function createBinaryStl(triangles: number, declared = triangles, header = "", value = 0): ArrayBuffer {
  const data = new ArrayBuffer(84 + 50 * triangles);
  new Uint8Array(data).set(new TextEncoder().encode(header));
  const view = new DataView(data);
  view.setUint32(80, declared, true);
  for (let i = 0; i < triangles; i++) {
    for (let j = 0; j < 9; j++) view.setFloat32(84 + 50 * i + 12 + 4 * j, j === 0 ? value : j, true);
  }
  return data;
}

function formatFacet(...vertices: string[]): string {
  return `facet normal 0 0 1\nouter loop\n${vertices.map((vertex) => `vertex ${vertex}\n`).join("")}endloop\nendfacet\n`;
}

const FACET = formatFacet("0 0 0", "1 0 0", "0 1 0");

function positionsOf({ parts: [part] }: MeshTemplate): number[] {
  return [...(part?.geometry as BufferGeometry).getAttribute("position").array];
}

function createGlb(json: string, declared?: number, version = 2): ArrayBuffer {
  const text = new TextEncoder().encode(json);
  const data = new ArrayBuffer(20 + text.length);
  const view = new DataView(data);
  new Uint8Array(data).set(new TextEncoder().encode("glTF"));
  view.setUint32(4, version, true);
  view.setUint32(8, declared ?? data.byteLength, true);
  view.setUint32(12, text.length, true);
  new Uint8Array(data).set(new TextEncoder().encode("JSON"), 16);
  new Uint8Array(data).set(text, 20);
  return data;
}

describe("COLLADA that is not valid XML", () => {
  it.each([
    ['<node id="<STL_BINARY>" name=\'a<b\'/>', '<node id="&lt;STL_BINARY>"  name=\'a&lt;b\' />'],
    ['<author a="1"b="2">R&D &amp; &#65; &lt;</author>', '<author a="1" b="2" >R&amp;D &amp; &#65; &lt;</author>'],
    ["<a><!-- made -- by hand --><b/></a>", "<a><b/></a>"],
    ["<p>1 0 2</p>", "<p>1 0 2</p>"],
  ])("is read as RViz reads it: %s", (text, fixedText) => {
    expect(fixXml(text)).toBe(fixedText);
  });
});

describe("STL", () => {
  it("is read as binary and as text, also binary that begins like text", async () => {
    const triangle = [0, 1, 2, 3, 4, 5, 6, 7, 8];
    expect(positionsOf(await readData("stl", createBinaryStl(1)))).toEqual(triangle);
    expect(positionsOf(await readData("STL".toLowerCase(), createBinaryStl(1, 1, "solid of something")))).toEqual(triangle);
    expect(positionsOf(await readData("stl", `solid a box\n${FACET}endsolid a box\n`))).toEqual([0, 0, 0, 1, 0, 0, 0, 1, 0]);
    expect(positionsOf(await readData("stl", `\ufeffSOLID\r\n${FACET.toUpperCase()}${FACET}`))).toHaveLength(18);
  });

  it("that is truncated reports how much is missing", async () => {
    expect(await readError("stl", createBinaryStl(12, 40_000_000))).toBe("the STL file declares 40 000 000 triangles and has 12");
    expect(await readError("stl", createBinaryStl(1, 3, "solid"))).toBe("the STL file declares 3 triangles and has 1");
    expect(await readError("stl", new ArrayBuffer(12))).toContain("it is not an STL file");
    expect(await readError("stl", new ArrayBuffer(84))).toBe("the STL file has no triangles");
    expect(await readError("stl", "solid nothing\n")).toBe("the STL file has no triangles");
    expect(await readError("stl", new ArrayBuffer(0))).toBe("the file is empty");
  });

  it("as text reports the line of the error", async () => {
    const prefix = "the ASCII STL is broken at line ";
    expect(await readError("stl", `solid\n${formatFacet("0 0 0", "1 0,5 0", "0 1 0")}`)).toBe(`${prefix}5: '0,5' instead of a number`);
    expect(await readError("stl", `solid\n${formatFacet("0 0 0", "1 0 0")}`)).toBe(`${prefix}6: a facet with 2 vertices instead of 3`);
    expect(await readError("stl", `solid\n${FACET}fac`)).toBe(`${prefix}9: 'fac' instead of 'facet'`);
    expect(await readError("stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n")).toBe(`${prefix}4: the file ends where a number should be`);
    expect(await readError("stl", "solid\nfacet normal 0 0 1\nouter loop\nvortex 0 0 0\n")).toBe(`${prefix}4: 'vortex' instead of 'vertex'`);
  });
});

describe("non-finite vertices", () => {
  it("are counted, and their triangles are not drawn", async () => {
    const template = await readData("stl", `solid\n${FACET}${formatFacet("nan 0 0", "5 inf 0", "0 1 0")}endsolid`);
    expect(template.problem).toBe("2 vertices have coordinates that are not finite numbers; 1 triangles with them are left out");
    expect(positionsOf(template)).toEqual([0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]);
    expect(await readError("stl", createBinaryStl(2, 2, "", NaN))).toBe("none of its triangles can be drawn: 2 vertices have coordinates that are not finite numbers");
  });

  it("remove only the faces that contain them", async () => {
    const template = await readData("obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n");
    expect(template.problem).toBe("1 vertices have coordinates that are not finite numbers; 1 triangles with them are left out");
    const { BufferAttribute, BufferGeometry } = await import("three");
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(new Float32Array([9, 9, 9, 1, 0, 0, NaN, 1, 0, 0, 0, 1]), 3));
    geometry.setIndex([0, 1, 3, 0, 1, 2]);
    expect(collapseNonFinite(geometry)).toEqual({ vertices: 1, triangles: 1, totalTriangles: 2 });
    expect([...(geometry.index?.array ?? [])]).toEqual([0, 1, 3, 0, 0, 0]);
    geometry.computeBoundingBox();
    expect(geometry.boundingBox?.max.toArray()).toEqual([9, 9, 9]);
  });
});

describe("other mesh files", () => {
  it("report their faults in readable sentences", async () => {
    expect(await readError("obj", "v 0 0 0\n# nothing else\n")).toBe("the OBJ file has no faces");
    expect(await readError("obj", "<html>not here</html>")).toContain("it is not an OBJ file");
    expect(await readError("glb", "PK\x03\x04, a zip")).toContain("it is not a GLB file");
    expect(await readError("glb", createGlb("{}", 4000))).toBe("the GLB file declares 4 000 bytes and has 22");
    expect(await readError("glb", createGlb("{}", undefined, 1))).toBe("it is glTF 1; only 2.0 is supported");
    expect(await readError("glb", createGlb("{]"))).toBe("the glTF is not valid JSON");
    expect(await readError("gltf", "{]")).toBe("the glTF is not valid JSON");
    expect(await readError("gltf", '{"asset": {"version": "1.0"}}')).toBe("it is glTF 1.0; only 2.0 is supported");
    const draco = '{"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_draco_mesh_compression"]}';
    expect(await readError("gltf", draco)).toBe("it needs the extension 'KHR_draco_mesh_compression', which is not supported");
    expect(await readError("ply", "ply")).toContain("no reader for '.ply'");
  });

  it("never show JavaScript's error messages", async () => {
    const warn = vi.spyOn(console, "warn").mockImplementation(() => undefined);
    expect(await readError("glb", createGlb('{"asset": {"version": "2.0"}, "meshes": 3, "nodes": [{"mesh": 7}], "scenes": [{"nodes": [0]}]}'))).toContain(
      "it cannot be read",
    );
    warn.mockRestore();
  });
});

describe("the mesh library", () => {
  function readLoadError(answer: () => Promise<Response>): Promise<string> {
    const library = new MeshLibrary(new MeshProgress(), { ...NO_FILES, fetch: answer });
    return library.load("/mesh/a/b.stl", ".STL").then(
      () => "",
      (reason: unknown) => (reason instanceof Error ? reason.message : "?"),
    );
  }

  it("reports why a file is not available", async () => {
    expect(await readLoadError(() => Promise.resolve(new Response("no", { status: 404 })))).toBe("the server does not have the file (404)");
    expect(await readLoadError(() => Promise.reject(new TypeError("Failed to fetch")))).toBe("the connection was lost during the download");
    const forbiddenResponse = new Response("a link leads out of the package\nmore", { status: 403, headers: { "Content-Type": "text/plain" } });
    expect(await readLoadError(() => Promise.resolve(forbiddenResponse))).toBe("a link leads out of the package");
    const largeResponse = new Response("", { headers: { "Content-Length": "7000000000" } });
    expect(await readLoadError(() => Promise.resolve(largeResponse))).toBe("the file has 7000 MB, and meshes of at most 500 MB are drawn");
    const compressedResponse = new Response("", { headers: { "Content-Encoding": "gzip", "Content-Length": "7", "X-Unpacked-Length": "7000000000" } });
    expect(await readLoadError(() => Promise.resolve(compressedResponse))).toBe("the file has 7000 MB, and meshes of at most 500 MB are drawn");
  });
});

describe("the progress of meshes", () => {
  beforeEach(() => vi.useFakeTimers());
  afterEach(() => vi.useRealTimers());

  it("is reported after half a second, first in bytes, then as being read", async () => {
    vi.stubGlobal("requestAnimationFrame", (call: () => void) => setTimeout(call, 16));
    const progress = new MeshProgress();
    const formatLoads = (): string[] => progress.loads.map((load) => `${load.name} ${formatProgress(load)}`);
    const report = progress.startLoad("arm.stl");
    report.onBytes(20_000, null);
    expect(formatLoads()).toEqual([]);
    await vi.advanceTimersByTimeAsync(500);
    expect(formatLoads()).toEqual(["arm.stl 20 kB"]);
    report.onBytes(1_200_000, 4_000_000);
    expect(formatLoads()).toEqual(["arm.stl 1.2 MB of 4.0 MB"]);
    void report.startReading();
    expect(formatLoads()).toEqual(["arm.stl reading"]);
    report.end();
    expect(formatLoads()).toEqual([]);
    vi.unstubAllGlobals();
  });

  it("is reported at once for large files that are being read, and never for those that load quickly", async () => {
    vi.stubGlobal("requestAnimationFrame", (call: () => void) => setTimeout(call, 16));
    const progress = new MeshProgress();
    const smallLoad = progress.startLoad("small.stl");
    smallLoad.onBytes(100, 100);
    await smallLoad.startReading();
    smallLoad.end();
    const largeLoad = progress.startLoad("large.stl");
    largeLoad.onBytes(50_000_000, 50_000_000);
    let isReading = false;
    void largeLoad.startReading().then(() => (isReading = true));
    expect([progress.loads.length, isReading]).toEqual([1, false]);
    await vi.advanceTimersByTimeAsync(200);
    expect(isReading).toBe(true);
    largeLoad.end();
    await vi.advanceTimersByTimeAsync(1000);
    expect(progress.loads).toEqual([]);
    vi.unstubAllGlobals();
  });
});
