import{c as O}from"/page/chunk.UDWSOI27.js";import{a as G}from"/page/chunk.5YVEHBYU.js";import{a as R,b as N,c as V}from"/page/chunk.UEXDQ7EF.js";import{a as D}from"/page/chunk.HMJ2MS2C.js";import{A as C,I as z,c as S,d as w,f as T,h as P,j as L,l as s,m as E,n as A,o as M,q as p,r as b,u as k,v as f,x as F,z as B}from"/page/chunk.64GWOZLD.js";import{d as x}from"/page/chunk.J55MVDNC.js";import"/page/chunk.OTD3EZO2.js";import"/page/chunk.NXAOJ7MN.js";import"/page/chunk.2CIZEZMD.js";import"/page/chunk.F5XGFZ2T.js";var U=["lit","clay","albedo","specularity","shading","residual","change"],j=`
  in vec3 tint;
  in float albedo;
  in float specularity;
  in vec3 posed;
  in vec3 posedNormal;
  in float lit;
  in float posedLit;
  in float shift;
  in vec2 mark;
  out vec2 vMark;
  out float vLit;
  out float vPosedLit;
  out vec3 vPosition;
  out vec3 vNormal;
  out vec3 vTint;
  out vec2 vReflectance;
  out vec3 vPosed;
  out vec3 vPosedNormal;
  out float vShift;
  out vec3 vSeenNormal;
  void main() {
    vSeenNormal = normalMatrix * normal;
    vPosition = position;
    vNormal = normal;
    vTint = tint;
    vReflectance = vec2(albedo, specularity);
    vPosed = posed;
    vPosedNormal = posedNormal;
    vLit = lit;
    vPosedLit = posedLit;
    vShift = shift;
    vMark = mark;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`,W=`
  precision highp float;
  in vec3 vPosition;
  in vec3 vNormal;
  in vec3 vTint;
  in vec2 vReflectance;
  in vec3 vPosed;
  in vec3 vPosedNormal;
  in float vShift;
  in float vLit;
  in float vPosedLit;
  in vec3 vSeenNormal;
  in vec2 vMark;
  uniform bool hasSurroundings;
  uniform float surroundings[9];
  uniform int surface;
  uniform bool isPoint;
  uniform vec3 lightVector;
  uniform vec3 posedLight;
  uniform float lightDistance;
  uniform float ambient;
  uniform float exponent;
  uniform vec3 eye;
  uniform vec3 clay;
  uniform sampler2D picture;
  uniform vec2 pictureSize;
  uniform vec3 intrinsics;
  out vec4 colour;

  vec2 eq1(vec3 position, vec3 normal, vec3 toEye, vec3 light) {
    vec3 path = isPoint ? light - position : light;
    float intensity = isPoint ? lightDistance * lightDistance / dot(path, path) : 1.0;
    vec3 toLight = normalize(path);
    float facing = dot(toLight, normal);
    if (facing <= 0.0) return vec2(0.0);
    float mirror = max(dot(normalize(toLight + toEye), normal), 0.0);
    return intensity * vec2(facing, pow(mirror, exponent));
  }

  float fromSurroundings(vec3 n) {
    float sum = 0.2820947918 * surroundings[0]
      + 0.4886025119 * dot(vec3(surroundings[3], surroundings[1], surroundings[2]), n)
      + 1.0925484306 * (surroundings[4] * n.x * n.y + surroundings[5] * n.y * n.z + surroundings[7] * n.x * n.z)
      + 0.3153915653 * surroundings[6] * (3.0 * n.z * n.z - 1.0)
      + 0.5462742153 * surroundings[8] * (n.x * n.x - n.y * n.y);
    return max(sum, 0.0);
  }

  // What a surface of this albedo and specularity shows, given the factors of Eq. 1.
  vec3 shaded(vec3 albedo, float specularity, vec3 normal, vec2 terms, float isLit) {
    if (!hasSurroundings) return ambient + albedo * terms.x + specularity * terms.y;
    return albedo * (fromSurroundings(normal) + isLit * terms.x) + specularity * isLit * terms.y;
  }

  vec3 encoded(vec3 linear) {
    vec3 clipped = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(clipped, vec3(1.0 / 2.4)) - 0.055, clipped * 12.92, lessThanEqual(clipped, vec3(0.0031308)));
  }

  vec3 decoded(vec3 display) {
    return mix(pow((display + 0.055) / 1.055, vec3(2.4)), display / 12.92, lessThanEqual(display, vec3(0.04045)));
  }

  // The lamp walks along with the eye: no side of a form lies in the dark.
  vec3 claySurface(vec3 seen, vec3 normal, vec3 toEye) {
    float key = max(dot(seen, normalize(vec3(-0.45, 0.65, 0.62))), 0.0);
    float sky = 0.5 + 0.5 * seen.y;
    float rim = pow(1.0 - max(dot(normal, toEye), 0.0), 3.0);
    return clay * (0.16 + 0.22 * sky + 0.66 * key) + 0.05 * rim;
  }

  // Of the picture and of Eq. 1 at the same place of the surface, whatever it is seen from.
  vec3 residualSurface() {
    vec3 normal = normalize(vPosedNormal);
    vec3 toEye = normalize(-vPosed);
    if (dot(normal, toEye) < 0.2) return vec3(0.35);
    vec2 pixel = intrinsics.x * vec2(vPosed.x, -vPosed.y) / -vPosed.z + intrinsics.yz;
    vec2 place = pixel / pictureSize;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(1.0)))) return vec3(0.35);
    float seen = dot(decoded(texture(picture, vec2(place.x, 1.0 - place.y)).rgb), vec3(0.2126, 0.7152, 0.0722));
    vec2 terms = eq1(vPosed, normal, toEye, posedLight);
    float difference = seen - shaded(vec3(vReflectance.x), vReflectance.y, normal, terms, vPosedLit).x;
    float strength = clamp(abs(difference) / 0.12, 0.0, 1.0);
    vec3 hue = difference > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    return mix(vec3(0.78), hue, strength);
  }

  // How far shading moved the surface, full colour at 1 cm, over a little clay for its form.
  vec3 changeSurface(vec3 normal, vec3 toEye) {
    float strength = clamp(abs(vShift) / 0.01, 0.0, 1.0);
    vec3 hue = vShift > 0.0 ? vec3(0.80, 0.13, 0.02) : vec3(0.02, 0.18, 0.62);
    float form = 0.45 + 0.55 * max(dot(normal, toEye), 0.0);
    return form * mix(vec3(0.78), hue, strength);
  }

  void main() {
    vec3 normal = normalize(vNormal);
    vec3 toEye = normalize(eye - vPosition);
    vec3 seen = normalize(vSeenNormal);
    if (!gl_FrontFacing) {
      normal = -normal;
      seen = -seen;
    }
    vec2 terms = eq1(vPosition, normal, toEye, lightVector);
    vec3 linear;
    if (surface == 1) linear = claySurface(seen, normal, toEye);
    else if (surface == 2) linear = vTint;
    else if (surface == 3) linear = vec3(vReflectance.y);
    else if (surface == 4) linear = shaded(vec3(0.5), 0.2, normal, terms, vLit);
    else if (surface == 5) linear = residualSurface();
    else if (surface == 6) linear = changeSurface(normal, toEye);
    else linear = shaded(vTint, vReflectance.y, normal, terms, vLit);
    // Limbs that were turned, and the one pointed at.
    linear = mix(linear, vec3(0.08, 0.3, 0.75) * (0.4 + 0.6 * max(seen.z, 0.0)), 0.6 * clamp(vMark.y, 0.0, 1.0));
    linear = mix(linear, vec3(1.0, 0.38, 0.02) * (0.5 + 0.5 * max(seen.z, 0.0)), 0.55 * vMark.x);
    colour = vec4(encoded(linear), 1.0);
  }
`,H=new s(.74,.66,.58);function q(o,e){let{light:t}=o;return new C({glslVersion:P,vertexShader:j,fragmentShader:W,side:S,uniforms:{surface:{value:0},isPoint:{value:t?.kind==="point"},lightVector:{value:new s(...t?.vector??[0,0,1])},posedLight:{value:new s(...t?.vector??[0,0,1])},lightDistance:{value:t?.distance??1},hasSurroundings:{value:t?.surroundings!=null},surroundings:{value:t?.surroundings??new Array(9).fill(0)},ambient:{value:t?.ambient??.1},exponent:{value:t?.exponent??20},eye:{value:new s},clay:{value:H},picture:{value:e},pictureSize:{value:K(o.camera)},intrinsics:{value:Y(o.camera)}}})}function K(o){return new L(o?.width??1,o?.height??1)}function Y(o){return new s(o?.fx??1,o?.cx??0,o?.cy??0)}function I(o,e){let[t,r,i]=[o.positions,e.positions,e.normals];return Float32Array.from({length:r.length/3},(a,n)=>{let c=0;for(let l=3*n;l<3*n+3;l++)c+=(r[l]-t[l])*i[l];return c})}function g(o,e,t){let r=o.positions.length/3,i=(u,d)=>new Float32Array(d*r).fill(u),a=new b,n=(u,d,h)=>a.setAttribute(u,new p(d,h));n("position",o.positions,3),n("normal",o.normals,3),n("posed",e.positions,3),n("posedNormal",e.normals,3),n("tint",X(o.colours,e.light?.colourScale??1)??i(.6,3),3),n("albedo",o.albedo??i(.6,1),1),n("specularity",o.specularity??i(0,1),1),n("lit",o.lit??i(1,1),1),n("posedLit",e.lit??i(1,1),1),n("shift",i(0,1),1),n("mark",i(0,2),2),a.setIndex(new p(o.triangles,1)),a.computeBoundingBox();let c=a.boundingBox,l=c.getCenter(new s),m=q(e,t);return o!==e&&e.light&&Q(m,e,l),{mesh:new f(a,m),centre:l,size:c.getSize(new s)}}function Q(o,e,t){if(e.light.kind!=="point")return;let r=new b;r.setAttribute("position",new p(e.positions,3)),r.computeBoundingBox();let i=r.boundingBox.getCenter(new s);o.uniforms.lightVector.value.sub(i).add(t)}function X(o,e){return o&&o.map(t=>t*e)}var J=.0028,Z=96,$=6,ee={colour:10634271,opacity:.8},te={colour:16753951,opacity:1},ie=.22,v=class{constructor(e){this.lines=e;for(let[t,r]of Object.entries(e)){let i=new f(re(r),new k({transparent:!0}));this.tapes.set(t,i),this.group.add(i)}this.mark(null)}lines;group=new A;tapes=new Map;mark(e){let t=e!==null&&this.tapes.has(e);for(let[r,i]of this.tapes){let a=r===e;i.visible=a||x(r);let n=a?te:ee;i.material.color.setHex(n.colour),i.material.opacity=t&&!a?ie:n.opacity,i.material.depthTest=!a,i.renderOrder=a?2:1}}endsOn(e,t,r){return[...this.tapes].filter(([,i])=>i.visible).map(([i])=>{let a=this.lines[i].map(([m,u,d])=>{let h=new s(m,u,d).project(e);return[(.5+.5*h.x)*t,(.5-.5*h.y)*r]}),[n,...c]=a,l=m=>c.reduce((u,d)=>m*d[0]>m*u[0]?d:u,n);return{name:i,left:l(-1),right:l(1)}})}dispose(){for(let e of this.tapes.values())e.geometry.dispose(),e.material.dispose()}};function re(o){let e=o.map(([r,i,a])=>new s(r,i,a)),t=e.length>3&&e[0].equals(e.at(-1));return t&&e.pop(),new B(new F(e,t),Z,J,$,t)}var oe=.35,_=class{constructor(e,t,r,i,a){this.body=t;this.upright=r;this.renderer=new z({canvas:e,alpha:!0,antialias:!0}),this.renderer.setPixelRatio(Math.min(window.devicePixelRatio||1,2)),this.renderer.setClearColor(0,0),this.texture=new E(i),this.texture.colorSpace=T,this.texture.generateMipmaps=!1,this.texture.minFilter=w,this.texture.needsUpdate=!0,this.parts=this.added({posed:t,canonical:r}),this.tapes=new v(a),this.scene.add(this.tapes.group,this.floor.mesh),this.facing=D(t,r),this.table=new V(e,()=>this.draw()),this.place("picture")}body;upright;renderer;scene=new M;table;parts;outlined=null;cues="SES";kind="lit";marked=null;texture;tapes;floor=new G;facing;onTapes=null;placement="picture";limbTools=null;flips=O;pointedAt=null;scheduled=0;isSized=!1;place(e){this.placement=e,this.reveal(),this.table.enabled=e!=="picture",this.renderer.domElement.style.touchAction=e==="picture"?"auto":"pan-y",e!=="picture"&&(this.setUpright(),this.table.lookAt(this.shown(),e==="canonical"?oe:0),this.layFloor()),this.draw()}lookFrom(e){if(this.placement==="picture")return;let t=this.placement==="canonical"?0:this.facing;this.table.lookAt(this.shown(),t+N[e]),this.draw()}followTapes(e){this.onTapes=e,this.draw()}surface(e){this.kind=e;for(let t of this.all())t.mesh.material.uniforms.surface.value=U.indexOf(e);this.draw()}compareWith(e){if(!(!e||this.outlined)){if(this.outlined=this.added(e),this.upright&&e.canonical){let t=new p(I(e.canonical,this.upright),1);for(let r of y(this.parts))r.mesh.geometry.setAttribute("shift",t)}this.reveal(),this.draw()}}show(e){this.cues=e,this.reveal(),this.draw()}mark(e){this.marked=e,this.tapes.mark(e),this.draw()}useLimbs(e){this.limbTools=e,this.turnLimbs(this.flips)}turnLimbs(e){this.flips=e,this.limbTools?.reshape(this.parts.posed.mesh,this.limbTools.bent(this.body,e)??this.body),this.placement==="turned"&&this.layFloor(),this.markLimb(this.pointedAt)}markLimb(e){this.pointedAt=e,this.limbTools?.markLimbs(this.parts.posed.mesh,e,this.flips),this.draw()}limbAt(e,t){let{mesh:r}=this.parts.posed;if(!this.limbTools||this.shown().mesh!==r)return null;let{left:i,top:a,width:n,height:c}=this.renderer.domElement.getBoundingClientRect();return this.limbTools.limbUnder(r,this.table.camera,2*(e-i)/n-1,1-2*(t-a)/c)}resize(e,t){e===0||t===0||(this.renderer.setSize(e,t,!1),this.table.aspect=e/t,this.isSized=!0,this.render())}turnBy(e){return this.placement!=="picture"&&this.table.turnBy(e)}dispose(){cancelAnimationFrame(this.scheduled),this.table.dispose(),this.texture.dispose(),this.tapes.dispose(),this.floor.dispose();for(let e of this.all())e.mesh.geometry.dispose(),e.mesh.material.dispose();this.renderer.dispose()}shown(){let{posed:e,canonical:t}=this.cues==="SE"&&this.outlined||this.parts;return this.placement==="canonical"&&t?t:e}added({posed:e,canonical:t}){let r={posed:g(e,e,this.texture),canonical:t&&g(t,e,this.texture)};for(let i of y(r))this.scene.add(i.mesh);return r}all(){return[...y(this.parts),...this.outlined?y(this.outlined):[]]}reveal(){let e=this.shown();for(let t of this.all())t.mesh.visible=t===e;this.tapes.group.visible=e===this.parts.canonical,this.floor.mesh.visible=this.placement==="canonical"||this.placement==="turned"&&this.body.upright!==null}layFloor(){let{mesh:e,centre:t}=this.shown(),r=e.geometry.getAttribute("position"),i=Array.from({length:r.count},(a,n)=>new s().fromBufferAttribute(r,n).applyMatrix4(e.matrixWorld));this.floor.layUnder(i,t)}draw(){cancelAnimationFrame(this.scheduled),this.scheduled=requestAnimationFrame(()=>this.render())}render(){if(!this.isSized)return;let{mesh:e}=this.shown(),{camera:t}=this.table;this.placement==="picture"?this.useFittedCamera():this.useFreeCamera(),this.setUpright(),e.material.uniforms.eye.value.copy(e.worldToLocal(t.position.clone())),this.renderer.render(this.scene,t);let{clientWidth:r,clientHeight:i}=this.renderer.domElement;this.onTapes?.(this.tapes.group.visible?this.tapes.endsOn(t,r,i):[]);let a=this.cues==="SE"&&this.outlined?"SE":"SES",{dataset:n}=this.renderer.domElement;n.shows=[this.placement,this.kind,a,this.marked??"none"].join(" "),this.limbTools&&(n.limbs=[this.pointedAt??"none",...Object.entries(this.flips).flat()].join(" "))}setUpright(){for(let{posed:e}of[this.parts,this.outlined??this.parts]){let{mesh:t,centre:r}=e;t.quaternion.identity(),this.placement==="turned"&&this.body.upright&&t.quaternion.fromArray(this.body.upright),t.position.copy(r).sub(r.clone().applyQuaternion(t.quaternion)),t.updateMatrixWorld()}}useFreeCamera(){this.table.camera.fov=R,this.table.camera.updateProjectionMatrix()}useFittedCamera(){let{camera:e}=this.body;if(!e)return;let t=.02,r=100,i=this.table.camera;i.position.set(0,0,0),i.quaternion.identity(),i.updateMatrixWorld(),i.projectionMatrix.makePerspective(-e.cx/e.fx*t,(e.width-e.cx)/e.fx*t,e.cy/e.fx*t,-(e.height-e.cy)/e.fx*t,t,r),i.projectionMatrixInverse.copy(i.projectionMatrix).invert()}};function y({posed:o,canonical:e}){return e?[o,e]:[o]}export{_ as BodyScene};
