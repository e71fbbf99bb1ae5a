// A body in motion, as the service writes it: a mesh with morph targets, and by frame their weights, its place and how it is turned.
import { glbParts } from "./glb";

export interface Motion {
  /** Of each frame, seconds. */
  readonly times: Float32Array;
  /** Frames x targets. */
  readonly weights: Float32Array;
  /** Frames x 3, metres. */
  readonly places: Float32Array;
  /** Frames x 4, quaternions. */
  readonly rotations: Float32Array;
  /** What each adds to the mesh. */
  readonly targets: readonly { readonly positions: Float32Array; readonly normals: Float32Array }[];
}

export interface Moment {
  readonly weights: readonly number[];
  readonly place: readonly number[];
  readonly rotation: readonly number[];
}

/** Null of a body that does not move. */
export function readMotion(content: ArrayBuffer): Motion | null {
  const { document, floats } = glbParts(content);
  const [animation] = document.animations ?? [];
  const { targets } = document.meshes[0]!.primitives[0]!;
  if (!animation || !targets) return null;
  const by = (path: string) => {
    const channel = animation.channels.find(({ target }) => target.path === path)!;
    return animation.samplers[channel.sampler]!;
  };
  return {
    times: floats(by("weights").input),
    weights: floats(by("weights").output),
    places: floats(by("translation").output),
    rotations: floats(by("rotation").output),
    targets: targets.map(({ POSITION, NORMAL }) => ({ positions: floats(POSITION), normals: floats(NORMAL) })),
  };
}

export function lengthOf({ times }: Motion): number {
  return times.at(-1)!;
}

/** Between two frames all is in proportion: they are a thirtieth of a second apart, or less. */
export function momentOf({ times, weights, places, rotations, targets }: Motion, seconds: number): Moment {
  const after = Math.max(1, times.findIndex((time) => time >= seconds));
  const [from, to] = [times[after - 1]!, times[after]!];
  const share = Math.min(1, Math.max(0, (seconds - from) / (to - from)));
  const mixed = (values: Float32Array, width: number) =>
    Array.from({ length: width }, (_, i) => {
      const before = values[(after - 1) * width + i]!;
      return before + share * (values[after * width + i]! - before);
    });
  return { weights: mixed(weights, targets.length), place: mixed(places, 3), rotation: mixed(rotations, 4) };
}
