import type { meshes as english } from "../en/meshes";

/** The faults of mesh files, as parts of a sentence, and the progress of loading. */
export const meshes: typeof english = {
  empty: "文件是空的",
  gone: "服务器上没有这个文件（404）",
  lost: "获取文件时连接中断",
  answered: (status: string): string => `服务器回答 ${status}`,
  tooLarge: (bytes: string, most: string): string => `文件大小为 ${bytes}，最多只绘制 ${most} 的网格`,
  noReader: (format: string): string => `无法读取“.${format}”网格；可读取 STL、DAE、OBJ、GLB 和 GLTF`,
  unreadable: (format: string): string => `读取失败：这不是有效的 ${format} 文件，或者含有不支持的内容`,
  noFaces: (format: string): string => `${format} 文件中没有面`,
  noVertices: "没有一行给出顶点（“v x y z”）：这不是 OBJ 文件",
  missing: (files: string): string => `无法加载 ${files}`,
  missingTextures: (files: string): string => `无法加载纹理 ${files}`,
  missingMaterials: (file: string): string => `无法加载材质文件“${file}”`,
  notNumbers: (vertices: string, triangles: string): string => `${vertices} 个顶点不是有限的数；含有它们的 ${triangles} 个三角形未绘制`,
  onlyNotNumbers: (vertices: string): string => `没有可绘制的三角形：${vertices} 个顶点不是有限的数`,
  stl: {
    short: (bytes: string): string => `这不是 STL：开头不是“solid”，而二进制 STL 至少有 84 字节，此文件只有 ${bytes}`,
    fewer: (said: string, held: string): string => `STL 声称有 ${said} 个三角形，实际只有 ${held} 个`,
    none: "STL 文件中没有三角形",
    line: (line: string, problem: string): string => `ASCII STL 在第 ${line} 行出错：${problem}`,
    unexpectedWord: (found: string, expected: string): string => `此处是“${found}”，应为${expected}`,
    unexpectedEnd: (expected: string): string => `文件到此结束，此处应为${expected}`,
    number: "一个数",
    corners: (count: string): string => `一个面片有 ${count} 个顶点，应为 3 个`,
  },
  dae: {
    notXml: (line: string): string => `DAE 不是有效的 XML${line === "" ? "" : `，第 ${line} 行`}`,
    root: (tag: string): string => `文件是 XML，但不是 COLLADA：根元素是 <${tag}>`,
  },
  gltf: {
    magic: "这不是 GLB：开头不是“glTF”",
    length: (said: string, held: string): string => `GLB 声称有 ${said} 字节，实际有 ${held} 字节`,
    notJson: "glTF 不是有效的 JSON",
    version: (version: string): string => `这是 glTF ${version}，可读取的是 2.0`,
    extension: (names: string): string => `需要扩展 ${names}，而此扩展不支持`,
  },
  progress: {
    title: "正在加载网格",
    reading: "正在读取",
    of: (bytes: string, total: string): string => `${bytes}，共 ${total}`,
    more: (count: string): string => `另有 ${count} 个`,
  },
};
