// SPDX-License-Identifier: MIT
#include "assimp/AssimpFile.h"

#include "assimp/SceneConversion.h"
#include "gltf/file/Uri.h"

#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/IOSystem.hpp>
#include <assimp/postprocess.h>
#include <assimp/ProgressHandler.hpp>
#include <assimp/scene.h>
#include <assimp/version.h>

#include <chrono>
#include <filesystem>
#include <set>
#include <system_error>
#include <vector>

namespace osgGpuAnimation::assimp
{

namespace
{

/// Regular files of a folder, to read. Assimp 6 has a DefaultIOSystem that is final.
class FolderFiles : public Assimp::IOSystem
{
public:
    FolderFiles(const std::string& fileName, bool allowOutsideFiles) : _allowOutsideFiles(allowOutsideFiles)
    {
        std::error_code failure;
        _folder = std::filesystem::canonical(fileName, failure).parent_path();
    }

    bool Exists(const char* file) const override
    {
        std::error_code failure;
        const std::filesystem::path path = std::filesystem::canonical(file, failure);
        if (failure || !std::filesystem::is_regular_file(path, failure)) return false;
        return (_allowOutsideFiles || gltf::isBelow(path, _folder)) &&
               std::filesystem::file_size(path, failure) <= maxFileBytes;
    }

    Assimp::IOStream* Open(const char* file, const char* mode) override
    {
        return Exists(file) && mode[0] == 'r' ? _files.Open(file, mode) : nullptr;
    }

    void Close(Assimp::IOStream* stream) override { _files.Close(stream); }
    char getOsSeparator() const override { return _files.getOsSeparator(); }
    bool ComparePaths(const char* one, const char* second) const override { return _files.ComparePaths(one, second); }

private:
    Assimp::DefaultIOSystem _files;
    std::filesystem::path _folder;
    bool _allowOutsideFiles;
};

class TimeLimit : public Assimp::ProgressHandler
{
public:
    bool Update(float) override { return std::chrono::steady_clock::now() < _end; }

private:
    std::chrono::steady_clock::time_point _end =
        std::chrono::steady_clock::now() +
        std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(maxSeconds));
};

/// Assimp 5.4 alone gives the bones of FBX files offsets from the parent's local matrix in place of the mesh's world
/// matrix (its issue 5642).
bool hasOffsetsOfParents(const aiScene& scene)
{
    aiString format;
    return aiGetVersionMajor() == 5 && aiGetVersionMinor() == 4 && scene.mMetaData &&
           scene.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format) &&
           std::string(format.C_Str()).find("FBX") != std::string::npos;
}

void correctOffsets(const aiScene& scene)
{
    struct Place
    {
        const aiNode* node;
        aiMatrix4x4 world;
    };
    std::set<const aiMesh*> corrected;              // the first node that has it gave it its offsets
    std::vector<Place> open{{scene.mRootNode, {}}}; // offsets come before the root's turn
    while (!open.empty())
    {
        const Place parent = open.back();
        open.pop_back();
        aiMatrix4x4 withoutLocal = parent.node == scene.mRootNode ? aiMatrix4x4() : parent.node->mTransformation;
        withoutLocal.Inverse();
        for (unsigned int i = parent.node->mNumChildren; i > 0; --i)
        {
            const aiNode* const node = parent.node->mChildren[i - 1];
            const aiMatrix4x4 world = parent.world * node->mTransformation;
            open.push_back({node, world});
            for (unsigned int number = 0; number < node->mNumMeshes; ++number)
            {
                const aiMesh* const mesh = scene.mMeshes[node->mMeshes[number]];
                if (!corrected.insert(mesh).second) continue;
                for (unsigned int bone = 0; bone < mesh->mNumBones; ++bone)
                    mesh->mBones[bone]->mOffsetMatrix *= withoutLocal * world;
            }
        }
    }
}

std::string firstLine(const std::string& text)
{
    return text.substr(0, text.find('\n'));
}

} // namespace

bool isFormat(const std::string& extension)
{
    return !extension.empty() && Assimp::Importer().IsExtensionSupported(extension);
}

Result<const aiScene*> readScene(Assimp::Importer& importer, const std::string& fileName,
                                 const gltf::ImportOptions& options)
{
    std::error_code failure;
    if (std::filesystem::file_size(fileName, failure) > maxFileBytes && !failure)
        return Error{"the file has more than " + std::to_string(maxFileBytes) + " bytes"};
    importer.SetIOHandler(new FolderFiles(fileName, options.allowOutsideFiles)); // the importer deletes both
    importer.SetProgressHandler(new TimeLimit);
    // Otherwise each joint of FBX becomes a chain of nodes with names of Assimp's own.
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    const aiScene* const scene = importer.ReadFile(
        fileName, aiProcess_Triangulate | aiProcess_SortByPType | aiProcess_LimitBoneWeights |
                      aiProcess_JoinIdenticalVertices | aiProcess_GenSmoothNormals | aiProcess_GlobalScale |
                      aiProcess_FindInvalidData | aiProcess_ValidateDataStructure);
    if (!scene) return Error{"Assimp cannot read it: " + gltf::printable(firstLine(importer.GetErrorString()), 300)};
    if (hasOffsetsOfParents(*scene)) correctOffsets(*scene);
    return scene;
}

Result<std::string> readAsGlb(const std::string& fileName, const gltf::ImportOptions& options, gltf::Report& report)
{
    Assimp::Importer importer;
    const Result<const aiScene*> scene = readScene(importer, fileName, options);
    return scene ? glbOf(*scene.value(), fileName, options, report) : scene.error();
}

} // namespace osgGpuAnimation::assimp
