// Textures: of the picture, or of one's own.
import type { TextureColours, TextureSize } from "../../api/types";
import { LIMITS } from "../../api/limits";
import { messages } from "../../messages";
import { Choice } from "../../ui/Choice";
import { FileButton } from "../../ui/FileButton";
import type { Kind, OptionProps } from "./kind";

interface TextureWishes {
  readonly colours: TextureColours;
  readonly size: TextureSize;
  /** A texture of one's own, in the atlas' layout. */
  readonly texture: File | null;
}

const words = messages.products.texture;

export const FIRST_TEXTURE: TextureWishes = { colours: "picture", size: 1024, texture: null };

export const texture: Kind<TextureWishes> = {
  request: ({ colours, size }) => ({ kind: "texture", colours, ...(colours === "own" ? {} : { size }) }),
  part: ({ colours, texture }) => (colours === "own" && texture ? { name: "texture", file: texture } : null),
  lacks: ({ colours, texture }) => (colours === "own" && !texture ? words.lacks : null),
  Options: TextureChoice,
  picture: "texture.png",
  body: { file: "body_textured.glb", label: words.turned },
};

function TextureChoice({ hasLight, wishes, onWish }: OptionProps<TextureWishes>) {
  const photographed = { value: "picture", ...words.photographed } as const;
  const unlit = { value: "albedo", ...words.unlit } as const;
  const own = { value: "own", ...words.own } as const;
  return (
    <>
      <Choice<TextureColours>
        name="colours"
        legend={words.colours}
        options={hasLight ? [photographed, unlit, own] : [photographed, own]}
        value={wishes.colours}
        onChange={(colours) => onWish({ colours })}
      />
      {!hasLight && <p class="fine">{words.onlyShading}</p>}
      {wishes.colours === "own" ? (
        <div class="row">
          <FileButton accept="image/png,image/jpeg,image/webp" onChoose={([file]) => onWish({ texture: file! })}>
            {words.choose}
          </FileButton>
          <span class="fine grow">{wishes.texture ? words.laid(wishes.texture.name) : words.square}</span>
        </div>
      ) : (
        <div class="field">
          <label for="texture-size">{words.size}</label>
          <select id="texture-size" value={wishes.size} onChange={(event) => onWish({ size: Number(event.currentTarget.value) as TextureSize })}>
            {LIMITS.textureSizes.map((size) => (
              <option key={size} value={size}>
                {size} × {size}
              </option>
            ))}
          </select>
        </div>
      )}
    </>
  );
}
