// Finds the places of a source file where a fault can be planted, and plants one: ./dev faults.
//
//   faults list FOLDER FILE...       one fault a line: file, line, place, length, what is written there instead, the
//                                    line as it stands (columns between tabs; place and length in bytes of the file)
//   faults plant FROM TO PLACE LENGTH TEXT      copies FROM to TO with that fault

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <iterator>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace {

std::string textOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) {
        std::cerr << path << ": cannot be read\n";
        std::exit(2);
    }
    return {std::istreambuf_iterator<char>(file), {}};
}

/// The line with blanks in place of strings and comments; nothing of a line that is no statement.
std::string codeOf(const std::string& line) {
    static const std::regex no_code(R"(^\s*(#|//|static_assert|template|using|namespace|friend).*)");
    if (std::regex_match(line, no_code)) return std::string(line.size(), ' ');
    std::string code = line;
    bool quoted = false;
    for (std::size_t i = 0; i < code.size(); ++i) {
        if (!quoted && code.compare(i, 2, "//") == 0) {
            code.replace(i, std::string::npos, code.size() - i, ' ');
            break;
        }
        if (code[i] == '"') quoted = !quoted;
        if (quoted || code[i] == '"') code[i] = ' ';
    }
    return code;
}

struct Exchange {
    std::regex pattern;  // its first group is exchanged
    std::vector<std::string> by;
};

const std::vector<Exchange>& exchanges() {
    static const std::vector<Exchange> all{
        {std::regex(R"( (<) )"), {"<=", ">="}},
        {std::regex(R"( (<=) )"), {"<", ">"}},
        {std::regex(R"( (>) )"), {">=", "<="}},
        {std::regex(R"( (>=) )"), {">", "<"}},
        {std::regex(R"( (==) )"), {"!="}},
        {std::regex(R"( (!=) )"), {"=="}},
        {std::regex(R"( (\+) )"), {"-"}},
        {std::regex(R"( (-) )"), {"+"}},
        {std::regex(R"( (\*) )"), {"/"}},
        {std::regex(R"( (/) )"), {"*"}},
        {std::regex(R"( (\+=) )"), {"-="}},
        {std::regex(R"( (-=) )"), {"+="}},
        {std::regex(R"( (\|) )"), {"&"}},
        {std::regex(R"( (&&) )"), {"||"}},
        {std::regex(R"( (\|\|) )"), {"&&"}},
        {std::regex(R"((?:[({]|[,=?:] |return )(-)[A-Za-z_(0-9])"), {""}},
        {std::regex(R"((!)[A-Za-z_(])"), {""}},
        {std::regex(R"(\b(min|max)\()"), {}},
        {std::regex(R"(\b(cwiseMin|cwiseMax)\()"), {}},
        {std::regex(R"(\b(true|false)\b)"), {}},
    };
    return all;
}

std::string opposite(const std::string& word) {
    static const std::vector<std::pair<std::string, std::string>> pairs{
        {"min", "max"}, {"cwiseMin", "cwiseMax"}, {"true", "false"}};
    for (const auto& [one, other] : pairs) {
        if (word == one) return other;
        if (word == other) return one;
    }
    return word;
}

struct Fault {
    std::size_t place, length;  // within the line
    std::string text;
};

void addExchanges(const std::string& code, std::vector<Fault>& faults) {
    for (const Exchange& exchange : exchanges()) {
        // A match may begin where the one before ends, as in a + b + c.
        auto from = code.cbegin();
        for (std::smatch match; std::regex_search(from, code.cend(), match, exchange.pattern);) {
            const auto place = static_cast<std::size_t>(match[1].first - code.cbegin());
            const std::string was = match[1].str();
            if (exchange.by.empty()) faults.push_back({place, was.size(), opposite(was)});
            for (const std::string& by : exchange.by) faults.push_back({place, was.size(), by});
            from = match[1].second;
        }
    }
}

/// Numbers: a tenth and ten times of one with a point, one more and one less of a whole one.
void addNumbers(const std::string& code, std::vector<Fault>& faults) {
    static const std::regex number(R"((0x[0-9a-f.]+p[-+]?\d+|\d+\.\d*(e[-+]?\d+)?|\d+e[-+]?\d+)|(\d+)(u?)\b)");
    if (code.find("Matrix<") != std::string::npos) return;
    for (std::sregex_iterator it(code.begin(), code.end(), number), end; it != end; ++it) {
        const auto place = static_cast<std::size_t>(it->position());
        const std::string was = it->str();
        const char before = place > 0 ? code[place - 1] : ' ';
        if (std::isalnum(static_cast<unsigned char>(before)) || before == '_' || before == '<' || before == '.')
            continue;
        if ((*it)[1].matched) {
            if (std::strtod(was.c_str(), nullptr) == 0.0) continue;
            faults.push_back({place, was.size(), "(10.0 * " + was + ")"});
            faults.push_back({place, was.size(), "(0.1 * " + was + ")"});
        } else {
            faults.push_back({place, was.size(), "(" + was + " + 1" + (*it)[4].str() + ")"});
            if (was[0] != '0') faults.push_back({place, was.size(), "(" + was + " - 1" + (*it)[4].str() + ")"});
        }
    }
}

/// A statement that stands on a line of its own and declares nothing, left out.
void addOmission(const std::string& code, std::vector<Fault>& faults) {
    static const std::regex statement(
        R"(^( {4,})((\+\+|--)[\w.]+;|[A-Za-z_][\w.>-]*(\[[^\]]*\])?[\w.]*(\(\))?(\.\w+)* [-+*/|]?= .*;|[\w.:>-]+\(.*\);|(return|continue|break);|if \(.*\) [^{]*;)\s*$)");
    std::smatch match;
    if (!std::regex_match(code, match, statement)) return;
    int open = 0;
    for (const char c : code) open += c == '(' ? 1 : c == ')' ? -1 : 0;
    if (open != 0) return;
    const auto place = static_cast<std::size_t>(match.position(2));
    faults.push_back({place, static_cast<std::size_t>(match.length(2)), ";"});
}

void list(const std::string& folder, const std::string& file) {
    const std::string text = textOf(folder + "/" + file);
    std::size_t start = 0;
    for (std::size_t number = 1; start < text.size(); ++number) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        const std::string line = text.substr(start, end - start), code = codeOf(line);
        std::vector<Fault> faults;
        addExchanges(code, faults);
        addNumbers(code, faults);
        addOmission(code, faults);
        const std::size_t indent = std::min(line.find_first_not_of(' '), line.size());
        for (const Fault& fault : faults)
            std::cout << file << '\t' << number << '\t' << start + fault.place << '\t' << fault.length << '\t'
                      << fault.text << '\t' << line.substr(indent, fault.place - indent) << "⟦"
                      << line.substr(fault.place, fault.length) << " → " << fault.text << "⟧"
                      << line.substr(fault.place + fault.length) << '\n';
        start = end + 1;
    }
}

}  // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> given(argv + 1, argv + argc);
    if (given.size() >= 3 && given[0] == "list") {
        for (std::size_t i = 2; i < given.size(); ++i) list(given[1], given[i]);
        return 0;
    }
    if (given.size() == 6 && given[0] == "plant") {
        std::string text = textOf(given[1]);
        text.replace(std::stoul(given[3]), std::stoul(given[4]), given[5]);
        std::ofstream file(given[2], std::ios::binary);
        file << text;
        return file.good() ? 0 : 2;
    }
    std::cerr << "usage: faults list FOLDER FILE... | faults plant FROM TO PLACE LENGTH TEXT\n";
    return 2;
}
