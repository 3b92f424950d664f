import {
  Color,
  DoubleSide,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Float32BufferAttribute,
  Mesh,
  ShaderMaterial,
  type ColorRepresentation,
} from "three";

const VERTEX = /* glsl */ `
  attribute vec3 start;
  attribute vec3 end;
  uniform float width;
  void main() {
    vec3 from = (modelViewMatrix * vec4(start, 1.0)).xyz;
    vec3 to = (modelViewMatrix * vec4(end, 1.0)).xyz;
    vec3 at = mix(from, to, position.x);
    vec3 side = normalize(cross(to - from, at));
    gl_Position = projectionMatrix * vec4(at + side * position.y * width, 1.0);
  }
`;
const FRAGMENT = /* glsl */ `
  uniform vec3 color;
  uniform float opacity;
  void main() { gl_FragColor = vec4(color, opacity); }
`;

/** Line segments with a width in metres that turn towards the camera: RViz's billboard lines. */
export class WideLines {
  readonly root: Mesh<InstancedBufferGeometry, ShaderMaterial>;

  constructor() {
    const uniforms = { width: { value: 0.01 }, color: { value: new Color() }, opacity: { value: 1 } };
    this.root = new Mesh(
      quads(),
      new ShaderMaterial({ vertexShader: VERTEX, fragmentShader: FRAGMENT, uniforms, side: DoubleSide }),
    );
    this.root.frustumCulled = false;
  }

  /** `segments`: x y z of both ends of each segment, one after the other. */
  setSegments(segments: Float32Array): void {
    const count = segments.length / 6;
    const [starts, ends] = [new Float32Array(count * 3), new Float32Array(count * 3)];
    for (let i = 0; i < count; i++) {
      starts.set(segments.subarray(i * 6, i * 6 + 3), i * 3);
      ends.set(segments.subarray(i * 6 + 3, i * 6 + 6), i * 3);
    }
    // A geometry remembers the first number of instances it was drawn with: more of them need a new one.
    this.root.geometry.dispose();
    this.root.geometry = quads();
    this.root.geometry.setAttribute("start", new InstancedBufferAttribute(starts, 3));
    this.root.geometry.setAttribute("end", new InstancedBufferAttribute(ends, 3));
    this.root.geometry.instanceCount = count;
    this.root.visible = count > 0;
  }

  setStyle(color: ColorRepresentation, opacity: number, width: number): void {
    const { uniforms } = this.root.material;
    uniforms["color"] = { value: new Color(color) };
    uniforms["opacity"] = { value: opacity };
    uniforms["width"] = { value: width };
    this.root.material.transparent = opacity < 1;
    this.root.material.depthWrite = opacity >= 1;
    this.root.material.needsUpdate = true;
  }

  dispose(): void {
    this.root.removeFromParent();
    this.root.geometry.dispose();
    this.root.material.dispose();
  }
}

function quads(): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute([0, -0.5, 0, 1, -0.5, 0, 1, 0.5, 0, 0, 0.5, 0], 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  return geometry;
}
