// The body in motion.
import { FileChoice } from "../FileChoice";
import type { Kind, OptionProps } from "./kind";

interface AnimationWishes {
  /** A BVH file; without one the body walks. */
  readonly motion: File | null;
}

export const FIRST_ANIMATION: AnimationWishes = { motion: null };

export const animation: Kind<AnimationWishes> = {
  label: "Animation",
  help: "The body in motion: walking, or as a BVH file of motion capture says.",
  request: () => ({ kind: "animation" }),
  part: ({ motion }) => motion && { name: "bvh", file: motion },
  Options: MotionChoice,
  pictures: [{ file: "animation.webp", still: "animation.png", alt: "The body in motion" }],
  told: (result) => {
    if (result.kind !== "animation") return null;
    const seconds = (result.frames * result.frame_time_s).toFixed(1);
    return <p class="fine">{`By ${result.source}: ${seconds} s, ${result.travelled_m.toFixed(1)} m of way.`}</p>;
  },
};

function MotionChoice({ wishes: { motion }, onWish }: OptionProps<AnimationWishes>) {
  return (
    <div class="row">
      <FileChoice
        label={motion ? "Another BVH file" : "Choose a BVH file"}
        accept=".bvh"
        onChoose={(file) => onWish({ motion: file })}
      />
      {motion && (
        <button class="button is-small" type="button" onClick={() => onWish({ motion: null })}>
          Let it walk
        </button>
      )}
      <span class="fine grow">
        {motion
          ? `It moves as ${motion.name} says.`
          : "Without a file it walks. Joints may be named as by CMU, Mixamo, Rokoko or Blender."}
      </span>
    </div>
  );
}
