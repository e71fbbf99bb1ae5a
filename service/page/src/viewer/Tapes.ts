// Where measurements are taken, as tapes about the upright body; the one pointed at stands out.
import { CatmullRomCurve3, Group, Mesh, MeshBasicMaterial, TubeGeometry, Vector3 } from "three";
import type { Camera } from "three";
import { isChief } from "../result/reading";

/** By the measurements' names, points in the frame of the upright body, metres. */
export type TapeLines = Readonly<Record<string, readonly (readonly [number, number, number])[]>>;

/** Where a tape reaches farthest to the left and to the right on the canvas, pixels. */
export interface TapeEnds {
  readonly name: string;
  readonly left: readonly [number, number];
  readonly right: readonly [number, number];
}

const RADIUS_M = 0.0028;
const PIECES = 96;
const CORNERS = 6;
const PLAIN = { colour: 0xa2441f, opacity: 0.8 };
const MARKED = { colour: 0xffa51f, opacity: 1 };
const BESIDE_MARKED_OPACITY = 0.22;

export class Tapes {
  readonly group = new Group();
  private readonly tapes = new Map<string, Mesh<TubeGeometry, MeshBasicMaterial>>();

  constructor(private readonly lines: TapeLines) {
    for (const [name, line] of Object.entries(lines)) {
      const tape = new Mesh(tube(line), new MeshBasicMaterial({ transparent: true }));
      this.tapes.set(name, tape);
      this.group.add(tape);
    }
    this.mark(null);
  }

  mark(marked: string | null): void {
    const some = marked !== null && this.tapes.has(marked);
    for (const [name, tape] of this.tapes) {
      const isMarked = name === marked;
      // All of them at once would hide the body.
      tape.visible = isMarked || isChief(name);
      const look = isMarked ? MARKED : PLAIN;
      tape.material.color.setHex(look.colour);
      tape.material.opacity = some && !isMarked ? BESIDE_MARKED_OPACITY : look.opacity;
      // The one pointed at is seen through the body.
      tape.material.depthTest = !isMarked;
      tape.renderOrder = isMarked ? 2 : 1;
    }
  }

  /** Of the tapes that are drawn. */
  endsOn(camera: Camera, width: number, height: number): TapeEnds[] {
    return [...this.tapes].filter(([, tape]) => tape.visible).map(([name]) => {
      const places = this.lines[name]!.map(([x, y, z]) => {
        const seen = new Vector3(x, y, z).project(camera);
        return [(0.5 + 0.5 * seen.x) * width, (0.5 - 0.5 * seen.y) * height] as const;
      });
      const [first, ...others] = places;
      const farther = (sign: number) => others.reduce((found, place) => (sign * place[0] > sign * found[0] ? place : found), first!);
      return { name, left: farther(-1), right: farther(1) };
    });
  }

  dispose(): void {
    for (const tape of this.tapes.values()) {
      tape.geometry.dispose();
      tape.material.dispose();
    }
  }
}

/** Closed where its last point is its first, as a girth's is. */
function tube(line: TapeLines[string]): TubeGeometry {
  const points = line.map(([x, y, z]) => new Vector3(x, y, z));
  const closed = points.length > 3 && points[0]!.equals(points.at(-1)!);
  if (closed) points.pop();
  return new TubeGeometry(new CatmullRomCurve3(points, closed), PIECES, RADIUS_M, CORNERS, closed);
}
