// The tapes' names and values beside the body, each with a line to its tape.
import { useEffect, useRef, useState } from "preact/hooks";
import type { Signal } from "@preact/signals";
import type { Measurement } from "../api/types";
import { person } from "../draft/draft";
import { messages } from "../messages";
import { placedLabels } from "../viewer/labels";
import type { TapeEnds } from "../viewer/Tapes";
import { measureLabel, shortLabel, shown } from "./reading";

interface Props {
  readonly ends: Signal<readonly TapeEnds[]>;
  readonly measurements: readonly Measurement[];
  readonly marked: string | null;
  /** Whether the skin stands beside it, or in its corner where the stage is narrow. */
  readonly hasSkin: boolean;
  readonly onPoint: (name: string | null) => void;
  readonly onShow: (name: string) => void;
}

const STEP_PX = 23;
const MARGIN_PX = 6;
/** The skin's height in the corner, and its distance from the edges: `.look-beside`. */
const SKIN_PX = 166;
const LABEL_PX = 168;
/** Narrower than this the columns would cover the body: only a few are told. */
const WIDE_PX = 620;
const NARROW_LABEL_PX = 122;
const FEW: ReadonlySet<string> = new Set(["chest_girth", "waist_girth_smallest", "hip_girth", "thigh_girth", "upper_arm_girth"]);

export function TapeLabels({ ends, measurements, marked, hasSkin, onPoint, onShow }: Props) {
  const layer = useRef<HTMLDivElement>(null);
  const [room, setRoom] = useState({ width: 0, height: 0, isWhole: true });
  useEffect(() => {
    const stage = layer.current!.closest(".look-room")!;
    const observer = new ResizeObserver(([entry]) => {
      const { width, height } = entry!.contentRect;
      setRoom({ width, height, isWhole: width >= stage.clientWidth });
    });
    observer.observe(layer.current!);
    return () => observer.disconnect();
  }, []);
  const { units } = person.value;
  const isWide = room.width >= WIDE_PX;
  const byName = new Map(measurements.map((each) => [each.name, each]));
  const told = ends.value.filter(({ name }) => byName.has(name) && (isWide || FEW.has(name) || name === marked));
  const labels = placedLabels(told, { ...room, step: STEP_PX, covered: hasSkin && room.isWhole ? SKIN_PX : 0 });
  const width = isWide ? LABEL_PX : NARROW_LABEL_PX;
  return (
    <div class="tape-labels" ref={layer} role="group" aria-label={messages.look.tapes}>
      <svg aria-hidden="true">
        {labels.map(({ name, side, y, at }) => (
          <line key={name} class={name === marked ? "is-marked" : ""} x1={side === "left" ? MARGIN_PX + width : room.width - MARGIN_PX - width} y1={y} x2={at[0]} y2={at[1]} />
        ))}
      </svg>
      {labels.map(({ name, side, y }) => {
        const { value, unit } = shown(byName.get(name)!, units);
        return (
          <button
            key={name}
            type="button"
            class={`tape-label is-${side} ${name === marked ? "is-marked" : ""}`}
            style={{ top: `${y}px`, width: `${width}px` }}
            title={measureLabel(name)}
            onPointerEnter={() => onPoint(name)}
            onPointerLeave={() => onPoint(null)}
            onFocus={() => onPoint(name)}
            onBlur={() => onPoint(null)}
            onClick={() => onShow(name)}
          >
            <span>{shortLabel(name)}</span> <b>{value}</b> {isWide && <small>{unit}</small>}
          </button>
        );
      })}
    </div>
  );
}
