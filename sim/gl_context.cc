#include "sim/gl_context.h"

#include <GL/osmesa.h>
// osmesa.h brings OpenGL 1.x; this brings the types of all later functions.
#include <GL/glext.h>

#include <cstdlib>
#include <map>
#include <stdexcept>

namespace plumbline {
namespace {

constexpr char kUnavailable[] = "OSMesa gives no OpenGL 4.5 core context";

struct AnyFunction {
  OSMESAproc address = nullptr;
  template <typename Function>
  operator Function() const {
    return reinterpret_cast<Function>(address);
  }
};

AnyFunction load(const char* name) {
  const OSMESAproc address = OSMesaGetProcAddress(name);
  if (address == nullptr) throw std::runtime_error(std::string("OSMesa lacks the OpenGL function ") + name);
  return {address};
}

/// Everything comes from OSMesa itself: the process may also hold a system libGL, whose functions know no such context.
struct Functions {
  PFNGLCREATESHADERPROC CreateShader = load("glCreateShader");
  PFNGLSHADERSOURCEPROC ShaderSource = load("glShaderSource");
  PFNGLCOMPILESHADERPROC CompileShader = load("glCompileShader");
  PFNGLGETSHADERIVPROC GetShaderiv = load("glGetShaderiv");
  PFNGLGETSHADERINFOLOGPROC GetShaderInfoLog = load("glGetShaderInfoLog");
  PFNGLDELETESHADERPROC DeleteShader = load("glDeleteShader");
  PFNGLCREATEPROGRAMPROC CreateProgram = load("glCreateProgram");
  PFNGLATTACHSHADERPROC AttachShader = load("glAttachShader");
  PFNGLLINKPROGRAMPROC LinkProgram = load("glLinkProgram");
  PFNGLGETPROGRAMIVPROC GetProgramiv = load("glGetProgramiv");
  PFNGLGETPROGRAMINFOLOGPROC GetProgramInfoLog = load("glGetProgramInfoLog");
  PFNGLUSEPROGRAMPROC UseProgram = load("glUseProgram");
  PFNGLGETUNIFORMLOCATIONPROC GetUniformLocation = load("glGetUniformLocation");
  PFNGLUNIFORM1FPROC Uniform1f = load("glUniform1f");
  PFNGLUNIFORM4FPROC Uniform4f = load("glUniform4f");
  PFNGLUNIFORMMATRIX4FVPROC UniformMatrix4fv = load("glUniformMatrix4fv");
  PFNGLGENVERTEXARRAYSPROC GenVertexArrays = load("glGenVertexArrays");
  PFNGLBINDVERTEXARRAYPROC BindVertexArray = load("glBindVertexArray");
  PFNGLDELETEVERTEXARRAYSPROC DeleteVertexArrays = load("glDeleteVertexArrays");
  PFNGLGENBUFFERSPROC GenBuffers = load("glGenBuffers");
  PFNGLBINDBUFFERPROC BindBuffer = load("glBindBuffer");
  PFNGLDELETEBUFFERSPROC DeleteBuffers = load("glDeleteBuffers");
  PFNGLBUFFERDATAPROC BufferData = load("glBufferData");
  PFNGLENABLEVERTEXATTRIBARRAYPROC EnableVertexAttribArray = load("glEnableVertexAttribArray");
  PFNGLVERTEXATTRIBPOINTERPROC VertexAttribPointer = load("glVertexAttribPointer");
  PFNGLACTIVETEXTUREPROC ActiveTexture = load("glActiveTexture");
  PFNGLTEXSTORAGE2DPROC TexStorage2D = load("glTexStorage2D");
  PFNGLTEXSTORAGE3DPROC TexStorage3D = load("glTexStorage3D");
  PFNGLTEXSUBIMAGE3DPROC TexSubImage3D = load("glTexSubImage3D");
  decltype(&::glTexSubImage2D) TexSubImage2D = load("glTexSubImage2D");
  PFNGLGENFRAMEBUFFERSPROC GenFramebuffers = load("glGenFramebuffers");
  PFNGLBINDFRAMEBUFFERPROC BindFramebuffer = load("glBindFramebuffer");
  PFNGLGENRENDERBUFFERSPROC GenRenderbuffers = load("glGenRenderbuffers");
  PFNGLBINDRENDERBUFFERPROC BindRenderbuffer = load("glBindRenderbuffer");
  PFNGLRENDERBUFFERSTORAGEPROC RenderbufferStorage = load("glRenderbufferStorage");
  PFNGLFRAMEBUFFERRENDERBUFFERPROC FramebufferRenderbuffer = load("glFramebufferRenderbuffer");
  PFNGLCHECKFRAMEBUFFERSTATUSPROC CheckFramebufferStatus = load("glCheckFramebufferStatus");
  PFNGLCLIPCONTROLPROC ClipControl = load("glClipControl");
  PFNGLCLEARBUFFERFVPROC ClearBufferfv = load("glClearBufferfv");
  decltype(&::glGenTextures) GenTextures = load("glGenTextures");
  decltype(&::glDeleteTextures) DeleteTextures = load("glDeleteTextures");
  decltype(&::glBindTexture) BindTexture = load("glBindTexture");
  decltype(&::glTexParameteri) TexParameteri = load("glTexParameteri");
  decltype(&::glPixelStorei) PixelStorei = load("glPixelStorei");
  decltype(&::glViewport) Viewport = load("glViewport");
  decltype(&::glEnable) Enable = load("glEnable");
  decltype(&::glDisable) Disable = load("glDisable");
  decltype(&::glFrontFace) FrontFace = load("glFrontFace");
  decltype(&::glDepthFunc) DepthFunc = load("glDepthFunc");
  decltype(&::glDrawElements) DrawElements = load("glDrawElements");
  decltype(&::glFlush) Flush = load("glFlush");
  decltype(&::glReadPixels) ReadPixels = load("glReadPixels");
  decltype(&::glGetError) GetError = load("glGetError");
};

OSMesaContext create_context(int threads) {
  setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 1);
  // Mesa keeps compiled shaders in the user's home, written by a thread of its own. They cost 0.3 s to make.
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            4,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            5,
                            0};
  OSMesaContext context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (context == nullptr) throw std::runtime_error(kUnavailable);
  return context;
}

}  // namespace

struct GlContext::Impl {
  Impl(int frame_width, int frame_height, bool in_colour, int threads)
      : width(frame_width), height(frame_height), colour(in_colour), context(create_context(threads)) {}
  ~Impl() { OSMesaDestroyContext(context); }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void make_current();
  void make_framebuffer();
  GLuint compile(GLenum kind, const std::string& source);

  int width;
  int height;
  bool colour;
  OSMesaContext context;
  Functions gl;
  // OSMesa insists on a window of its own; nothing is drawn there.
  std::array<std::uint8_t, 4 * 4 * 4> window{};
  std::map<std::uint32_t, std::array<GLuint, 2>> buffers_of_mesh;
};

void GlContext::Impl::make_current() {
  if (OSMesaGetCurrentContext() == context) return;
  if (OSMesaMakeCurrent(context, window.data(), GL_UNSIGNED_BYTE, 4, 4) != GL_TRUE) {
    throw std::runtime_error(kUnavailable);
  }
}

void GlContext::Impl::make_framebuffer() {
  GLuint framebuffer = 0;
  GLuint buffers[2] = {};
  gl.GenFramebuffers(1, &framebuffer);
  gl.GenRenderbuffers(2, buffers);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffers[0]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, colour ? GL_RGBA32F : GL_R32F, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, buffers[0]);
  gl.BindRenderbuffer(GL_RENDERBUFFER, buffers[1]);
  gl.RenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT32F, width, height);
  gl.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, buffers[1]);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) throw std::runtime_error(kUnavailable);
  gl.Viewport(0, 0, width, height);
  gl.ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  gl.Enable(GL_DEPTH_TEST);
  gl.DepthFunc(GL_GREATER);
  gl.Enable(GL_CULL_FACE);
  // Images keep their top row first in memory, where OpenGL has its bottom row: the picture is mirrored, and so is
  // the winding.
  gl.FrontFace(GL_CW);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
}

GLuint GlContext::Impl::compile(GLenum kind, const std::string& source) {
  const GLuint shader = gl.CreateShader(kind);
  const GLchar* text = source.c_str();
  gl.ShaderSource(shader, 1, &text, nullptr);
  gl.CompileShader(shader);
  GLint compiled = GL_FALSE;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  if (compiled != GL_TRUE) {
    GLchar log[1024] = "";
    gl.GetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("a shader does not compile: ") + log);
  }
  return shader;
}

GlContext::GlContext(int width, int height, bool colour, int threads)
    : impl_(std::make_unique<Impl>(width, height, colour, threads)) {
  impl_->make_current();
  impl_->make_framebuffer();
}

GlContext::~GlContext() = default;

void GlContext::make_current() { impl_->make_current(); }

GlContext::Program GlContext::make_program(const std::string& vertex_shader, const std::string& fragment_shader) {
  const Functions& gl = impl_->gl;
  Program program;
  program.handle = gl.CreateProgram();
  for (const GLuint shader :
       {impl_->compile(GL_VERTEX_SHADER, vertex_shader), impl_->compile(GL_FRAGMENT_SHADER, fragment_shader)}) {
    gl.AttachShader(program.handle, shader);
    gl.DeleteShader(shader);
  }
  gl.LinkProgram(program.handle);
  GLint linked = GL_FALSE;
  gl.GetProgramiv(program.handle, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    GLchar log[1024] = "";
    gl.GetProgramInfoLog(program.handle, sizeof log, nullptr, log);
    throw std::runtime_error(std::string("a shader program does not link: ") + log);
  }
  const auto location = [&](const char* name) { return gl.GetUniformLocation(program.handle, name); };
  program.clip_from_chunk = location("clip_from_chunk");
  program.camera_from_chunk = location("camera_from_chunk");
  program.light_factor = location("light_factor");
  program.fog = location("fog");
  program.rig_lamp_cd = location("rig_lamp_cd");
  program.sun = location("sun");
  program.ambient_lux = location("ambient_lux");
  return program;
}

std::uint32_t GlContext::make_mesh(std::span<const float> vertices, std::span<const int> attribute_sizes,
                                   std::span<const std::uint32_t> indices) {
  const Functions& gl = impl_->gl;
  GLuint mesh = 0;
  std::array<GLuint, 2> buffers{};
  gl.GenVertexArrays(1, &mesh);
  gl.BindVertexArray(mesh);
  gl.GenBuffers(2, buffers.data());
  impl_->buffers_of_mesh[mesh] = buffers;
  gl.BindBuffer(GL_ARRAY_BUFFER, buffers[0]);
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size_bytes()), vertices.data(), GL_STATIC_DRAW);
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers[1]);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size_bytes()), indices.data(), GL_STATIC_DRAW);
  int components = 0;
  for (const int size : attribute_sizes) components += size;
  std::uintptr_t offset = 0;
  for (std::size_t i = 0; i < attribute_sizes.size(); ++i) {
    gl.EnableVertexAttribArray(static_cast<GLuint>(i));
    gl.VertexAttribPointer(static_cast<GLuint>(i), attribute_sizes[i], GL_FLOAT, GL_FALSE,
                           components * static_cast<GLsizei>(sizeof(float)), reinterpret_cast<const void*>(offset));
    offset += static_cast<std::uintptr_t>(attribute_sizes[i]) * sizeof(float);
  }
  return mesh;
}

void GlContext::delete_mesh(std::uint32_t mesh) {
  const auto found = impl_->buffers_of_mesh.extract(mesh);
  if (found.empty()) return;
  impl_->gl.DeleteVertexArrays(1, &mesh);
  impl_->gl.DeleteBuffers(2, found.mapped().data());
}

void GlContext::make_texture_array(int unit, int size, std::span<const std::vector<std::vector<float>>* const> layers) {
  const Functions& gl = impl_->gl;
  const auto level_count = static_cast<GLsizei>(layers.front()->size());
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
  gl.TexStorage3D(GL_TEXTURE_2D_ARRAY, level_count, GL_R32F, size, size, static_cast<GLsizei>(layers.size()));
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_NEAREST);
  gl.TexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  for (std::size_t layer = 0; layer < layers.size(); ++layer) {
    for (GLint level = 0; level < level_count; ++level) {
      gl.TexSubImage3D(GL_TEXTURE_2D_ARRAY, level, 0, 0, static_cast<GLint>(layer), size >> level, size >> level, 1,
                       GL_RED, GL_FLOAT, (*layers[layer])[static_cast<std::size_t>(level)].data());
    }
  }
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL does not take the world's textures");
}

std::uint32_t GlContext::make_texture(int width, int height, std::span<const float> texels) {
  const Functions& gl = impl_->gl;
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  gl.TexStorage2D(GL_TEXTURE_2D, 1, GL_R32F, width, height);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl.TexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RED, GL_FLOAT, texels.data());
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("OpenGL does not take the world's light map");
  return texture;
}

void GlContext::bind_texture(int unit, std::uint32_t texture) {
  impl_->gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  impl_->gl.BindTexture(GL_TEXTURE_2D, texture);
}

void GlContext::delete_texture(std::uint32_t texture) { impl_->gl.DeleteTextures(1, &texture); }

void GlContext::flush() { impl_->gl.Flush(); }

void GlContext::clear(const std::array<float, 3>& background) {
  const GLfloat colour[4] = {background[0], background[1], background[2], 1.0F};
  const GLfloat farthest = 0.0F;
  impl_->gl.ClearBufferfv(GL_COLOR, 0, colour);
  impl_->gl.ClearBufferfv(GL_DEPTH, 0, &farthest);
}

void GlContext::use(const Program& program) { impl_->gl.UseProgram(program.handle); }

void GlContext::set(std::int32_t uniform, float value) { impl_->gl.Uniform1f(uniform, value); }

void GlContext::set(std::int32_t uniform, const std::array<float, 4>& value) {
  impl_->gl.Uniform4f(uniform, value[0], value[1], value[2], value[3]);
}

void GlContext::set(std::int32_t uniform, const Matrix& value) {
  impl_->gl.UniformMatrix4fv(uniform, 1, GL_FALSE, value.data());
}

void GlContext::draw_both_sides(bool both) {
  if (both) {
    impl_->gl.Disable(GL_CULL_FACE);
  } else {
    impl_->gl.Enable(GL_CULL_FACE);
  }
}

void GlContext::draw(std::uint32_t mesh, int index_count) {
  impl_->gl.BindVertexArray(mesh);
  impl_->gl.DrawElements(GL_TRIANGLES, index_count, GL_UNSIGNED_INT, nullptr);
}

void GlContext::read_luminance(std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(impl_->width) * static_cast<std::size_t>(impl_->height));
  impl_->gl.ReadPixels(0, 0, impl_->width, impl_->height, GL_RED, GL_FLOAT, out.data());
}

void GlContext::read_rgb(std::vector<float>& out) {
  out.resize(3 * static_cast<std::size_t>(impl_->width) * static_cast<std::size_t>(impl_->height));
  impl_->gl.ReadPixels(0, 0, impl_->width, impl_->height, GL_RGB, GL_FLOAT, out.data());
}

void GlContext::read_depth(std::vector<float>& out) {
  out.resize(static_cast<std::size_t>(impl_->width) * static_cast<std::size_t>(impl_->height));
  impl_->gl.ReadPixels(0, 0, impl_->width, impl_->height, GL_DEPTH_COMPONENT, GL_FLOAT, out.data());
}

}  // namespace plumbline
