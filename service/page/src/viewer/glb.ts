// Reads the service's GLB files (glTF 2.0 binary, one mesh, one buffer): arrays, camera, light.

export interface GlbCamera {
  readonly fx: number;
  readonly cx: number;
  readonly cy: number;
  readonly width: number;
  readonly height: number;
}

export interface GlbLight {
  readonly kind: "point" | "directional";
  /** Where a point light stands; toward a directional one. */
  readonly vector: readonly [number, number, number];
  /** From the body's centre; 0 of a directional light. */
  readonly distance: number;
  readonly ambient: number;
  readonly exponent: number;
  /** By what vertex colours are to be multiplied to be albedo. */
  readonly colourScale: number;
}

export interface GlbBody {
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  readonly triangles: Uint16Array | Uint32Array;
  readonly colours: Float32Array | null;
  readonly specularity: Float32Array | null;
  /** Places in the texture, from its upper left corner. */
  readonly uv: Float32Array | null;
  readonly texture: Blob | null;
  /** Of a body with a texture, which is cut along seams: the number of each vertex in one that is not. */
  readonly uncut: Float32Array | null;
  /** Whether its colours have their light in them. */
  readonly unlit: boolean;
  readonly camera: GlbCamera | null;
  readonly light: GlbLight | null;
  /** The rotation, as a quaternion, that sets the camera's axes upright; null where it is not known. */
  readonly upright: readonly [number, number, number, number] | null;
}

interface Document {
  accessors: { bufferView: number; componentType: number; count: number; type: string; byteOffset?: number }[];
  bufferViews: { byteOffset?: number; byteLength: number }[];
  meshes: { primitives: { attributes: Record<string, number>; indices: number; targets?: { POSITION: number; NORMAL: number }[] }[] }[];
  animations?: { channels: { sampler: number; target: { path: string } }[]; samplers: { input: number; output: number }[] }[];
  materials?: { extensions?: { KHR_materials_unlit?: object } }[];
  images?: { bufferView: number; mimeType: string }[];
  nodes: { name?: string; translation?: [number, number, number]; rotation?: [number, number, number, number] }[];
  cameras?: { extras: Record<string, number> }[];
  extensions?: { KHR_lights_punctual?: { lights: { type: GlbLight["kind"]; extras: LightExtras }[] } };
}

interface LightExtras {
  readonly ambient: number;
  readonly specular_exponent: number;
  readonly colour_scale: number;
  readonly distance_m?: number;
}

const MAGIC = 0x46546c67;
const FLOAT = 5126;
const UNSIGNED_SHORT = 5123;
const WIDTHS: Readonly<Record<string, number>> = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4 };

export interface GlbParts {
  readonly document: Document;
  /** Where the buffer begins. */
  readonly binary: number;
  readonly array: (accessor: number) => Float32Array | Uint16Array | Uint32Array;
  readonly floats: (accessor: number) => Float32Array;
}

export function glbParts(content: ArrayBuffer): GlbParts {
  const header = new DataView(content);
  if (header.getUint32(0, true) !== MAGIC) throw new Error("This is no GLB file.");
  const jsonLength = header.getUint32(12, true);
  const document = JSON.parse(new TextDecoder().decode(new Uint8Array(content, 20, jsonLength))) as Document;
  const binary = 20 + jsonLength + 8;
  const array = (index: number) => {
    const accessor = document.accessors[index]!;
    const start = binary + (document.bufferViews[accessor.bufferView]!.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const length = accessor.count * WIDTHS[accessor.type]!;
    if (accessor.componentType === FLOAT) return new Float32Array(content.slice(start, start + 4 * length));
    if (accessor.componentType === UNSIGNED_SHORT) return new Uint16Array(content.slice(start, start + 2 * length));
    return new Uint32Array(content.slice(start, start + 4 * length));
  };
  return { document, binary, array, floats: (index) => array(index) as Float32Array };
}

export function readGlb(content: ArrayBuffer): GlbBody {
  const { document, binary, array } = glbParts(content);
  const primitive = document.meshes[0]!.primitives[0]!;
  const floats = (name: string) => {
    const index = primitive.attributes[name];
    return index === undefined ? null : (array(index) as Float32Array);
  };
  return {
    positions: floats("POSITION")!,
    normals: floats("NORMAL")!,
    triangles: array(primitive.indices) as Uint16Array | Uint32Array,
    colours: floats("COLOR_0"),
    specularity: floats("_SPECULARITY"),
    uv: floats("TEXCOORD_0"),
    texture: textureOf(document, content, binary),
    uncut: floats("_VERTEX"),
    unlit: document.materials?.[0]?.extensions?.KHR_materials_unlit !== undefined,
    camera: cameraOf(document),
    light: lightOf(document),
    upright: document.nodes.find((each) => each.name === "upright")?.rotation ?? null,
  };
}

/** A body in the texture of another, of the same mesh; as it is where that has none. */
export function dressed(body: GlbBody, skin: GlbBody): GlbBody {
  const { uncut, uv, triangles, texture, unlit } = skin;
  if (!uncut) return body;
  const cut = (values: Float32Array) => Float32Array.from({ length: 3 * uncut.length }, (_, i) => values[3 * uncut[Math.floor(i / 3)]! + (i % 3)]!);
  return { ...body, positions: cut(body.positions), normals: cut(body.normals), uv, triangles, texture, unlit, uncut };
}

function textureOf({ images, bufferViews }: Document, content: ArrayBuffer, binary: number): Blob | null {
  const image = images?.[0];
  if (!image) return null;
  const { byteOffset = 0, byteLength } = bufferViews[image.bufferView]!;
  const start = binary + byteOffset;
  return new Blob([content.slice(start, start + byteLength)], { type: image.mimeType });
}

function cameraOf(document: Document): GlbCamera | null {
  const extras = document.cameras?.[0]?.extras;
  if (!extras) return null;
  return {
    fx: extras.fx_px!,
    cx: extras.cx_px!,
    cy: extras.cy_px!,
    width: extras.width_px!,
    height: extras.height_px!,
  };
}

function lightOf(document: Document): GlbLight | null {
  const light = document.extensions?.KHR_lights_punctual?.lights[0];
  const node = document.nodes.find((each) => each.name === "light");
  if (!light || !node) return null;
  const { ambient, specular_exponent, colour_scale, distance_m } = light.extras;
  return {
    kind: light.type,
    vector: node.translation ?? turnedZ(node.rotation ?? [0, 0, 0, 1]),
    distance: distance_m ?? 0,
    ambient,
    exponent: specular_exponent,
    colourScale: colour_scale,
  };
}

/** Where a rotation takes +z: glTF's lights shine along -z, so this is toward the light. */
function turnedZ([x, y, z, w]: [number, number, number, number]): [number, number, number] {
  return [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)];
}
