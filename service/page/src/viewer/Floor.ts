// The floor a body stands on: lines half a metre apart that fade away, darker where the body is near.
import { DataTexture, GLSL3, LinearFilter, Mesh, PlaneGeometry, RedFormat, ShaderMaterial, Vector2 } from "three";
import type { Vector3 } from "three";

const SIDE_M = 3.2;
const CELLS = 96;
/** What is higher than this darkens the floor by 1/e of what touches it. */
const NEAR_M = 0.08;
const BLUR_CELLS = 2;

const VERTEX = /* glsl */ `
  out vec2 vPlace;
  void main() {
    vPlace = uv;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

const FRAGMENT = /* glsl */ `
  precision highp float;
  in vec2 vPlace;
  uniform sampler2D near;
  uniform float side;
  uniform vec2 walked;
  out vec4 colour;
  void main() {
    vec2 metres = (vPlace - 0.5) * side;
    float fade = 1.0 - smoothstep(0.25, 1.0, length(metres) / (0.5 * side));
    vec2 cell = abs(fract((metres + walked) / 0.5 + 0.5) - 0.5) * 0.5;
    vec2 width = max(fwidth(metres), vec2(0.004));
    vec2 line = 1.0 - smoothstep(vec2(0.0), width, cell);
    float dark = texture(near, vec2(vPlace.x, 1.0 - vPlace.y)).r;
    float alpha = max(max(line.x, line.y) * 0.3 * fade, 0.1 * fade);
    colour = vec4(mix(vec3(0.5), vec3(0.0), dark), max(alpha, 0.5 * dark));
  }
`;

export class Floor {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;
  private readonly near: DataTexture;

  constructor() {
    this.near = new DataTexture(new Uint8Array(CELLS * CELLS), CELLS, CELLS, RedFormat);
    this.near.minFilter = this.near.magFilter = LinearFilter;
    const material = new ShaderMaterial({
      glslVersion: GLSL3,
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      transparent: true,
      depthWrite: false,
      uniforms: { near: { value: this.near }, side: { value: SIDE_M }, walked: { value: new Vector2() } },
    });
    this.mesh = new Mesh(new PlaneGeometry(SIDE_M, SIDE_M).rotateX(-Math.PI / 2), material);
  }

  /** Lie under a body of these vertices, which stand in the world; y is up, and the ground where the lowest is unless it is known. */
  layUnder(vertices: readonly Vector3[], centre: Vector3, ground = vertices.reduce((least, { y }) => Math.min(least, y), Infinity)): void {
    this.mesh.position.set(centre.x, ground, centre.z);
    const weights = new Float32Array(CELLS * CELLS);
    for (const { x, y, z } of vertices) {
      const column = Math.floor(((x - centre.x) / SIDE_M + 0.5) * CELLS);
      const row = Math.floor(((z - centre.z) / SIDE_M + 0.5) * CELLS);
      if (column < 0 || row < 0 || column >= CELLS || row >= CELLS) continue;
      const at = row * CELLS + column;
      weights[at] = Math.max(weights[at]!, Math.exp((ground - y) / NEAR_M));
    }
    const values = this.near.image.data as Uint8Array;
    const soft = blurred(blurred(weights));
    soft.forEach((weight, i) => (values[i] = Math.min(255, Math.round(255 * weight))));
    this.near.needsUpdate = true;
  }

  /** A body that stays here has gone so far: the lines pass under it. */
  passUnder(x: number, z: number): void {
    this.mesh.material.uniforms.walked!.value.set(x, -z);
  }

  dispose(): void {
    this.near.dispose();
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** The mean over a square around each cell. */
function blurred(values: Float32Array): Float32Array {
  return values.map((_, i) => {
    const [row, column] = [Math.floor(i / CELLS), i % CELLS];
    let [sum, count] = [0, 0];
    for (let r = Math.max(0, row - BLUR_CELLS); r <= Math.min(CELLS - 1, row + BLUR_CELLS); r++) {
      for (let c = Math.max(0, column - BLUR_CELLS); c <= Math.min(CELLS - 1, column + BLUR_CELLS); c++) {
        sum += values[r * CELLS + c]!;
        count += 1;
      }
    }
    return sum / count;
  });
}
