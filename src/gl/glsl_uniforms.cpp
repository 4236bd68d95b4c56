#include "gl/glsl_uniforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "evenmesh/error.h"
#include "gl/glsl_values.h"
#include "shape/suggestions.h"

namespace evenmesh::gl {
namespace {

/// One name of a declaration.
struct Declarator {
  std::size_t name = 0;  ///< token
  bool array = false;
  std::size_t last = 0;  ///< token of the name with its brackets
  TokenRange initial{};  ///< "= …"; empty: none
};

struct Declaration {
  std::string storage{};  ///< "uniform", "in", …, or nothing
  std::size_t storage_at = 0;
  std::vector<std::size_t> in_the_way{};  ///< tokens that only make sense with the storage: layout (…), flat
  std::string type{};                     ///< empty: nothing is declared
  bool block = false;
  std::vector<Declarator> names{};
};

bool is_storage(const std::string& word) {
  static const std::set<std::string> all{"uniform", "in", "out", "varying", "attribute", "buffer", "shared"};
  return all.contains(word);
}

bool is_between(const std::string& word) {
  static const std::set<std::string> all{"flat", "smooth", "noperspective", "centroid", "invariant"};
  return all.contains(word);
}

bool is_qualifier(const std::string& word) {
  static const std::set<std::string> all{"const",    "highp",     "mediump",  "lowp",     "precise",
                                         "readonly", "writeonly", "restrict", "coherent", "volatile"};
  return all.contains(word);
}

bool is_opaque(std::string_view type) {
  return type.find("sampler") != std::string_view::npos || type.starts_with("image") || type.starts_with("iimage") ||
         type.starts_with("uimage") || type == "atomic_uint";
}

/// Reads one declaration outside of functions.
class Reader {
 public:
  Reader(const std::vector<GlslToken>& tokens, TokenRange range) : t_(tokens), i_(range.begin), end_(range.end) {}

  Declaration run() {
    qualifiers();
    if (i_ >= end_ || !t_[i_].is_word()) return std::move(d_);
    d_.type = t_[i_++].text;
    d_.block = i_ < end_ && t_[i_].is("{");
    bool array = false;
    while (i_ < end_ && t_[i_].is("[")) {
      skip_brackets();
      array = true;
    }
    while (!d_.block && i_ < end_ && t_[i_].is_word()) {
      declarator(array);
      if (i_ >= end_ || !t_[i_].is(",")) break;
      ++i_;
    }
    return std::move(d_);
  }

 private:
  void qualifiers() {
    for (; i_ < end_; ++i_) {
      const GlslToken& token = t_[i_];
      if (token.is("layout")) {
        const std::size_t first = i_++;
        skip_brackets();
        for (std::size_t k = first; k < i_; ++k) d_.in_the_way.push_back(k);
        --i_;
      } else if (is_storage(token.text)) {
        d_.storage = token.text;
        d_.storage_at = i_;
      } else if (is_between(token.text)) {
        d_.in_the_way.push_back(i_);
      } else if (!is_qualifier(token.text) && !token.is_directive()) {
        return;
      }
    }
  }

  /// Behind the bracket that closes the one at i_.
  void skip_brackets() {
    std::size_t depth = 0;
    for (; i_ < end_; ++i_) {
      if (t_[i_].is("(") || t_[i_].is("[") || t_[i_].is("{")) ++depth;
      if (t_[i_].is(")") || t_[i_].is("]") || t_[i_].is("}")) --depth;
      if (depth == 0 || depth > end_) break;
    }
    i_ = std::min(i_ + 1, end_);
  }

  void declarator(bool array) {
    Declarator one{i_, array, i_, {}};
    ++i_;
    while (i_ < end_ && t_[i_].is("[")) {
      skip_brackets();
      one.array = true;
      one.last = i_ - 1;
    }
    if (i_ < end_ && t_[i_].is("=")) {
      one.initial.begin = i_;
      while (i_ < end_ && !t_[i_].is(",") && !t_[i_].is(";")) {
        if (t_[i_].is("(") || t_[i_].is("[") || t_[i_].is("{")) {
          skip_brackets();
        } else {
          ++i_;
        }
      }
      one.initial.end = i_;
    }
    d_.names.push_back(one);
  }

  const std::vector<GlslToken>& t_;
  std::size_t i_, end_;
  Declaration d_{};
};

class Setter {
 public:
  Setter(const GlslText& text, std::vector<GlslToken>& tokens, const GlslOutline& outline,
         const std::set<std::string>& needed, const std::map<std::string, std::string>& definitions,
         const StageUniforms* stage)
      : text_(text), t_(tokens), outline_(outline), needed_(needed), given_(definitions), stage_(stage) {}

  Definitions run() {
    for (const GlslGlobal& global : outline_.globals) declaration(global.tokens);
    refuse_textures();
    host_constants();
    for (const auto& [name, value] : given_) {
      if (!used_.contains(name)) macro(name, value);
    }
    if (!missing_.empty())
      throw InvalidInput(fmt::format("{}: no value for the uniform{} {}; give {} with -D NAME=VALUE", text_.name,
                                     missing_.size() > 1 ? "s" : "", fmt::join(missing_, ", "),
                                     missing_.size() > 1 ? "each" : "it"));
    return std::move(result_);
  }

 private:
  void blank(TokenRange range) {
    for (std::size_t i = range.begin; i < range.end; ++i) {
      if (!t_[i].is_directive()) {
        t_[i].text.clear();
        t_[i].after.clear();
      }
    }
  }

  bool is_needed(const Declaration& d) const {
    return std::any_of(d.names.begin(), d.names.end(),
                       [&](const Declarator& n) { return needed_.contains(t_[n.name].text); });
  }

  void declaration(TokenRange range) {
    const Declaration d = Reader{t_, range}.run();
    if (d.storage.empty() || d.names.empty()) {
      for (const Declarator& name : d.names) declared_.insert(t_[name.name].text);
      if (d.storage.empty()) return;
      if (d.block && (d.storage == "uniform" || d.storage == "buffer"))
        fail_in_glsl(text_, t_[d.storage_at].offset, "blocks have no values here; declare uniforms one by one");
      if (stage_ != nullptr && d.block) return;
      return blank(range);  // layout(…) in; and the like
    }
    for (const Declarator& name : d.names) declared_.insert(t_[name.name].text);
    if (d.storage == "uniform") return is_of_stage(d) ? void() : uniform(d, range);
    if (stage_ != nullptr) return variables(d, range);
    if (!is_needed(d)) return blank(range);
    if (d.storage != "out")
      fail_in_glsl(text_, t_[d.storage_at].offset, "there are no vertices or pixels here that this could come from");
    t_[d.storage_at].text.clear();
    for (const std::size_t i : d.in_the_way) t_[i].text.clear();
  }

  /// What goes from stage to stage stays. The depth and the normal are variables of ours.
  void variables(const Declaration& d, TokenRange range) {
    for (const Declarator& name : d.names) {
      const GlslToken& token = t_[name.name];
      const bool in = d.storage == "in" || d.storage == "attribute";
      (in ? result_.inputs : result_.outputs)[token.text] = {d.type, token.offset};
      if (token.is("gl_FragDepth") || (!in && token.is("surface_normal"))) blank(range);
    }
  }

  /// Whether these are uniforms that whoever draws sets.
  bool is_of_stage(const Declaration& d) {
    if (stage_ == nullptr) return false;
    std::size_t count = 0;
    for (const Declarator& name : d.names) {
      const GlslToken& token = t_[name.name];
      const auto known = stage_->find(token.text);
      if (known == stage_->end()) continue;
      if (d.type != known->second || name.array)
        fail_in_glsl(text_, token.offset, "this name is taken: uniform " + known->second + " " + token.text);
      ++count;
    }
    if (count > 0 && count < d.names.size())
      fail_in_glsl(text_, t_[d.storage_at].offset, "declare the uniforms that need a value apart from the others");
    return count > 0;
  }

  void uniform(const Declaration& d, TokenRange range) {
    if (is_opaque(d.type)) {
      for (const Declarator& name : d.names) textures_.insert(t_[name.name].text);
      return blank(range);
    }
    for (const std::size_t i : d.in_the_way) t_[i].text.clear();
    t_[d.storage_at].text = "const";
    bool cannot_be_set = false;
    for (const Declarator& name : d.names) cannot_be_set = !set(d.type, name) || cannot_be_set;
    if (cannot_be_set) blank(range);
  }

  /// False where there is no value and none is needed.
  bool set(const std::string& type, const Declarator& one) {
    const std::string name = t_[one.name].text;
    const bool plain = is_plain_type(type) && !one.array;
    if (plain) uniforms_.push_back(type + " " + name);
    std::string value;
    if (const auto found = given_.find(name); found != given_.end()) {
      if (!plain)
        throw InvalidInput(fmt::format("{}: {} is an array or a struct, and these cannot be set", text_.name, name));
      value = glsl_value(type, name, found->second);
      used_.insert(name);
    } else if (one.initial.end > one.initial.begin) {
      return true;
    } else if (plain) {
      value = host_value(type, name);
      if (value.empty()) {
        if (needed_.contains(name)) missing_.push_back(type + " " + name);
        value = type + "(0)";
      }
    } else {
      if (!needed_.contains(name)) return false;
      fail_in_glsl(text_, t_[one.name].offset, "arrays and structs cannot be set; write the values here: const … = …");
    }
    blank(one.initial);
    t_[one.last].after = " = " + value;
    return true;
  }

  void refuse_textures() {
    const auto is_texture = [&](const std::string& word) {
      const bool channel = word.size() == 9 && word.starts_with("iChannel") && word[8] >= '0' && word[8] <= '9';
      return textures_.contains(word) || channel;
    };
    for (const GlslFunction& f : outline_.functions) {
      for (std::size_t i = f.tokens.begin; needed_.contains(f.name) && i < f.tokens.end; ++i) {
        if (t_[i].is_word() && is_texture(t_[i].text))
          fail_in_glsl(text_, t_[i].offset, "there are no textures here; compute the value instead");
      }
    }
    for (const std::string& word : needed_) {
      if (is_texture(word))
        throw UnusableInput(
            fmt::format("{}: {} is a texture, and there are none here; compute the value instead", text_.name, word));
    }
  }

  void host_constants() {
    std::set<std::string> words;
    for (const GlslToken& token : t_) {
      if (token.is_word()) words.insert(token.text);
    }
    for (const auto& [name, macro] : outline_.macros) words.insert(macro.words.begin(), macro.words.end());
    for (const std::string& word : words) {
      const std::optional<std::string_view> type = host_type(word);
      if (!type || declared_.contains(word)) continue;
      const auto found = given_.find(word);
      const std::string value =
          found == given_.end() ? host_value(*type, word) : glsl_value(*type, word, found->second);
      result_.constants.push_back(fmt::format("const {} {} = {};", *type, word, value));
      used_.insert(word);
    }
    if (words.contains("iChannelTime"))
      result_.constants.emplace_back("const float iChannelTime[4] = float[4](0.0, 0.0, 0.0, 0.0);");
    if (words.contains("iChannelResolution"))
      result_.constants.emplace_back("const vec3 iChannelResolution[4] = vec3[4](vec3(1), vec3(1), vec3(1), vec3(1));");
  }

  void macro(const std::string& name, const std::string& value) {
    const auto macro = outline_.macros.find(name);
    const bool defined = macro != outline_.macros.end() && !macro->second.has_arguments;
    if (!defined && !outline_.conditions.contains(name)) refuse(name);
    const auto harmless = [](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
             std::string_view(" _.,+-*/()<>=!&|?:").find(c) != std::string_view::npos;
    };
    const bool loop = value.find("for") != std::string::npos || value.find("while") != std::string::npos;
    const bool comment = value.find("//") != std::string::npos || value.find("/*") != std::string::npos;
    if (value.size() > 1000 || loop || comment || !std::all_of(value.begin(), value.end(), harmless))
      throw InvalidInput(
          fmt::format("the macro {} takes numbers, names and operators, not '{}'", name, value.substr(0, 60)));
    result_.macros.emplace(name, value);
  }

  [[noreturn]] void refuse(const std::string& name) const {
    std::vector<std::string> there = uniforms_;
    std::vector<std::string_view> names;
    for (const std::string& uniform : uniforms_)
      names.push_back(std::string_view(uniform).substr(uniform.find(' ') + 1));
    for (const auto& [known, macro] : outline_.macros) {
      if (macro.has_arguments) continue;
      there.push_back("macro " + known);
      names.push_back(known);
    }
    there.resize(std::min<std::size_t>(there.size(), 20));
    const std::string all = there.empty() ? "it has none at all" : fmt::format("it has {}", fmt::join(there, ", "));
    throw InvalidInput(fmt::format("{}: there is no uniform or macro '{}'{} ({})", text_.name, name.substr(0, 60),
                                   did_you_mean(name, names), all));
  }

  const GlslText& text_;
  std::vector<GlslToken>& t_;
  const GlslOutline& outline_;
  const std::set<std::string>& needed_;
  const std::map<std::string, std::string>& given_;
  const StageUniforms* stage_;
  std::set<std::string> declared_{}, used_{}, textures_{};
  std::vector<std::string> uniforms_{}, missing_{};  ///< "float k"
  Definitions result_{};
};

}  // namespace

Definitions set_uniforms(const GlslText& text, std::vector<GlslToken>& tokens, const GlslOutline& outline,
                         const std::set<std::string>& needed, const std::map<std::string, std::string>& definitions,
                         const StageUniforms* stage) {
  return Setter{text, tokens, outline, needed, definitions, stage}.run();
}

}  // namespace evenmesh::gl
